//! Unwraps the meshes of Bevy on its own threads, while its app runs.
//!
//! Give an entity with a `Mesh3d` an [`Unwrap`]. Some frames later its mesh has UVs, as an asset of
//! its own, and the entity an [`Unwrapped`] or an [`UnwrapFailed`]. Taking the [`Unwrap`] away
//! meanwhile ends the work.

use std::error::Error;

use beltrami::{CancelToken, Control, Surface, UnwrapOptions, Unwrapper, View};
use bevy_app::{App, Plugin, Update};
use bevy_asset::Assets;
use bevy_ecs::prelude::*;
use bevy_mesh::{Indices, Mesh, Mesh3d, PrimitiveTopology, VertexAttributeValues};
use bevy_tasks::{block_on, poll_once, AsyncComputeTaskPool, ComputeTaskPool, Task};

/// A sentence that says what to do.
pub type AnyError = Box<dyn Error + Send + Sync>;

/// Asks for UVs for the mesh of an entity.
#[derive(Component, Clone, Default)]
pub struct Unwrap(pub UnwrapOptions);

/// The mesh of the entity has its UVs: proven to be injective, or not.
#[derive(Component, Debug)]
pub struct Unwrapped {
    /// Whether no triangle is flipped, and no two overlap.
    pub injective: bool,
    /// Pieces of the layout.
    pub charts: usize,
}

/// Why the mesh of the entity has none.
#[derive(Component, Debug)]
pub struct UnwrapFailed(pub AnyError);

/// The work on a mesh, which is ended by dropping this.
#[derive(Component)]
struct Unwrapping {
    task: Task<Result<(Mesh, Unwrapped), AnyError>>,
    token: CancelToken,
}

impl Drop for Unwrapping {
    fn drop(&mut self) {
        self.token.cancel();
    }
}

/// The systems that see to it.
pub struct UnwrapPlugin;

impl Plugin for UnwrapPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(Update, (begin, finish, give_up).chain());
    }
}

type Idle = (Without<Unwrapping>, Without<Unwrapped>, Without<UnwrapFailed>);

fn begin(
    mut commands: Commands,
    meshes: Res<Assets<Mesh>>,
    wanted: Query<(Entity, &Unwrap, &Mesh3d), Idle>,
) {
    for (entity, Unwrap(options), handle) in &wanted {
        let Some(mesh) = meshes.get(handle) else { continue }; // not loaded yet
        let (mesh, options, token) = (mesh.clone(), options.clone(), CancelToken::new());
        let own = token.clone();
        let task = AsyncComputeTaskPool::get()
            .spawn(async move { unwrap(mesh, &options, Control::new().cancel_token(&own)) });
        commands.entity(entity).insert(Unwrapping { task, token });
    }
}

fn finish(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut running: Query<(Entity, &mut Unwrapping, &mut Mesh3d)>,
) {
    for (entity, mut unwrapping, mut handle) in &mut running {
        let Some(result) = block_on(poll_once(&mut unwrapping.task)) else { continue };
        let mut entity = commands.entity(entity);
        entity.remove::<Unwrapping>();
        match result {
            Ok((mesh, unwrapped)) => {
                handle.0 = meshes.add(mesh);
                entity.insert(unwrapped);
            }
            Err(error) => {
                entity.insert(UnwrapFailed(error));
            }
        }
    }
}

fn give_up(mut commands: Commands, orphans: Query<Entity, (With<Unwrapping>, Without<Unwrap>)>) {
    for entity in &orphans {
        commands.entity(entity).remove::<Unwrapping>();
    }
}

/// A mesh with UVs, its vertices split along the seams; all of their attributes are kept.
pub fn unwrap(
    mut mesh: Mesh,
    options: &UnwrapOptions,
    control: Control<'_>,
) -> Result<(Mesh, Unwrapped), AnyError> {
    if mesh.primitive_topology() != PrimitiveTopology::TriangleList {
        return Err("the mesh is no list of triangles".into());
    }
    let Some(VertexAttributeValues::Float32x3(positions)) =
        mesh.attribute(Mesh::ATTRIBUTE_POSITION)
    else {
        return Err("the mesh has no positions of three floats".into());
    };
    let indices: Vec<u32> = match mesh.indices() {
        Some(Indices::U32(indices)) => indices.clone(),
        Some(Indices::U16(indices)) => indices.iter().map(|&index| index.into()).collect(),
        None => (0..positions.len() as u32).collect(),
    };
    let mut unwrapper = Unwrapper::with_options(&options.clone().float32(true))?;
    unwrapper.run_loops_by(|count, job| {
        ComputeTaskPool::get().scope(|scope| {
            for index in 0..count {
                scope.spawn(async move { job(index) });
            }
        });
    });
    let surface = Surface::new(positions, View::<_, 3>::from_flat(&indices)?);
    let atlas = unwrapper.unwrap_with(&surface, control)?;
    let unwrapped = Unwrapped {
        injective: atlas.float32_certificate().injective,
        charts: atlas.summary().charts,
    };
    // Bevy copies a vertex for each index here, so these are the vertices that UVs are copies of.
    mesh.insert_indices(Indices::U32(atlas.origins()));
    mesh.duplicate_vertices();
    // V goes down from the top of a texture in Bevy.
    let uvs: Vec<[f32; 2]> = atlas.uvs::<[f32; 2]>().iter().map(|&[u, v]| [u, 1.0 - v]).collect();
    mesh.insert_attribute(Mesh::ATTRIBUTE_UV_0, uvs);
    mesh.insert_indices(Indices::U32(atlas.corner_uv_vertices()));
    Ok((mesh, unwrapped))
}
