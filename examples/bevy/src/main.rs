//! An app without a window: unwraps a torus and a ball, and says what became of them.

use beltrami::UnwrapOptions;
use beltrami_bevy::{Unwrap, UnwrapFailed, UnwrapPlugin, Unwrapped};
use bevy_app::{App, TaskPoolPlugin};
use bevy_asset::{AssetApp, AssetPlugin, Assets};
use bevy_ecs::prelude::*;
use bevy_math::primitives::{Sphere, Torus};
use bevy_mesh::{Mesh, Mesh3d, Meshable};

fn main() {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), AssetPlugin::default(), UnwrapPlugin));
    app.init_asset::<Mesh>();
    let world = app.world_mut();
    let mut meshes = world.resource_mut::<Assets<Mesh>>();
    let things = [Mesh::from(Torus::default()), Sphere::new(1.0).mesh().ico(8).unwrap()];
    let handles = things.map(|mesh| meshes.add(mesh));
    let options = UnwrapOptions::new().threads(2).margin(4.0);
    for handle in handles {
        world.spawn((Mesh3d(handle), Unwrap(options.clone())));
    }
    loop {
        app.update();
        let world = app.world_mut();
        let mut waiting =
            world.query_filtered::<(), (With<Unwrap>, Without<Unwrapped>, Without<UnwrapFailed>)>();
        if waiting.iter(world).next().is_none() {
            break;
        }
    }
    let world = app.world_mut();
    let mut failed = world.query::<&UnwrapFailed>();
    if let Some(UnwrapFailed(error)) = failed.iter(world).next() {
        panic!("{error}");
    }
    let mut done = world.query::<(&Mesh3d, &Unwrapped)>();
    let meshes = world.resource::<Assets<Mesh>>();
    for (handle, unwrapped) in done.iter(world) {
        let mesh = meshes.get(handle).expect("the asset is there");
        let uvs = mesh.attribute(Mesh::ATTRIBUTE_UV_0).expect("it has UVs");
        assert_eq!(uvs.len(), mesh.count_vertices());
        println!(
            "{} vertices in {} charts, injective: {}",
            mesh.count_vertices(),
            unwrapped.charts,
            unwrapped.injective
        );
    }
}
