//! Vectors of mint, in and out; and those of any other library, by their arrays.
#![cfg(feature = "mint")]

mod support;

use beltrami::{check_injective, Flattener, Mesh, View, ViewMut};
use mint::{Point3, Vector2, Vector3};
use support::{sheet, single};

#[test]
fn vectors_are_as_good_as_arrays() {
    let (positions, faces) = sheet(8);
    let single = single(&positions);
    let mut flattener = Flattener::new().unwrap();
    let mut flatten = |mesh: Mesh<'_>| flattener.flatten(&mesh).unwrap().uvs::<[f64; 2]>();
    let vectors: Vec<Vector3<f32>> = single.iter().copied().map(Vector3::from).collect();
    let points: Vec<Point3<f32>> = single.iter().copied().map(Point3::from).collect();
    let expected = flatten(Mesh::new(&single, &faces));
    assert_eq!(expected, flatten(Mesh::new(&vectors, &faces)));
    assert_eq!(expected, flatten(Mesh::new(&points, &faces)));
    let double: Vec<Point3<f64>> = positions.iter().copied().map(Point3::from).collect();
    assert_eq!(flatten(Mesh::new(&positions, &faces)), flatten(Mesh::new(&double, &faces)));
}

#[test]
fn uvs_come_as_vectors() {
    let (positions, faces) = sheet(8);
    let mut flattener = Flattener::new().unwrap();
    let map = flattener.flatten(&Mesh::new(&positions, &faces)).unwrap();
    let uvs = map.uvs::<Vector2<f32>>();
    assert_eq!(uvs.iter().map(|uv| [uv.x, uv.y]).collect::<Vec<_>>(), map.uvs::<[f32; 2]>());
    assert!(check_injective(&faces, &uvs).unwrap().injective);
    let double = map.uvs::<mint::Point2<f64>>();
    assert_eq!([double[5].x, double[5].y], map.uvs::<[f64; 2]>()[5]);
    assert!(check_injective(&faces, &double).unwrap().injective);
}

// glam stands for all whose vectors are arrays to AsRef and AsMut: nalgebra, cgmath, vek and others.
#[test]
fn vectors_of_other_libraries_are_read_where_they_are() {
    let (positions, faces) = sheet(8);
    let single = single(&positions);
    let mut flattener = Flattener::new().unwrap();
    let expected = flattener.flatten(&Mesh::new(&single, &faces)).unwrap().uvs::<[f32; 2]>();
    let aligned: Vec<glam::Vec3A> = single.iter().copied().map(glam::Vec3A::from).collect();
    let view = View::<f32, 3>::from_field(&aligned, AsRef::as_ref).unwrap();
    let map = flattener.flatten(&Mesh::new(view, &faces)).unwrap();
    let mut uvs = vec![glam::Vec2::ZERO; positions.len()];
    map.write_uvs(ViewMut::<f32, 2>::from_field(&mut uvs, AsMut::as_mut).unwrap()).unwrap();
    assert_eq!(uvs.iter().map(|uv| uv.to_array()).collect::<Vec<_>>(), expected);
}
