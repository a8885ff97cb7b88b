//! Vectors of glam, in and out.
#![cfg(feature = "glam")]

mod support;

use beltrami::{check_injective, Flattener, Mesh};
use glam::{DVec2, DVec3, Vec2, Vec3, Vec3A};
use support::{sheet, single};

#[test]
fn vectors_are_as_good_as_arrays() {
    let (positions, faces) = sheet(8);
    let single = single(&positions);
    let mut flattener = Flattener::new().unwrap();
    let mut flatten = |mesh: Mesh<'_>| flattener.flatten(&mesh).unwrap().uvs::<[f64; 2]>();
    let vectors: Vec<Vec3> = single.iter().copied().map(Vec3::from).collect();
    let aligned: Vec<Vec3A> = single.iter().copied().map(Vec3A::from).collect();
    let expected = flatten(Mesh::new(&single, &faces));
    assert_eq!(expected, flatten(Mesh::new(&vectors, &faces)));
    assert_eq!(expected, flatten(Mesh::new(&aligned, &faces)));
    let double: Vec<DVec3> = positions.iter().copied().map(DVec3::from).collect();
    assert_eq!(flatten(Mesh::new(&positions, &faces)), flatten(Mesh::new(&double, &faces)));
}

#[test]
fn uvs_come_as_vectors() {
    let (positions, faces) = sheet(8);
    let mut flattener = Flattener::new().unwrap();
    let map = flattener.flatten(&Mesh::new(&positions, &faces)).unwrap();
    let uvs = map.uvs::<Vec2>();
    assert_eq!(uvs.iter().map(|uv| uv.to_array()).collect::<Vec<_>>(), map.uvs::<[f32; 2]>());
    assert!(check_injective(&faces, &uvs).unwrap().injective);
    let double = map.uvs::<DVec2>();
    assert_eq!(double[5].to_array(), map.uvs::<[f64; 2]>()[5]);
    assert!(check_injective(&faces, &double).unwrap().injective);
    let mut room = vec![Vec2::ZERO; positions.len()];
    map.write_uvs(&mut room).unwrap();
    assert_eq!(room, uvs);
}
