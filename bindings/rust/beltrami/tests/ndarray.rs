//! Arrays of ndarray, in and out.
#![cfg(feature = "ndarray")]

mod support;

use beltrami::{
    check_injective, Error, Faces, Flattener, Mesh, Positions, Surface, Unwrapper, Uvs,
};
use ndarray::{s, Array2, ShapeBuilder};
use support::sheet;

#[test]
fn arrays_are_as_good_as_slices() {
    let (positions, faces) = sheet(8);
    let mut flattener = Flattener::new().unwrap();
    let expected = flattener.flatten(&Mesh::new(&positions, &faces)).unwrap().uvs::<[f64; 2]>();
    // Positions among other columns, as a table of vertices has them.
    let mut vertices = Array2::<f64>::zeros((positions.len(), 7));
    vertices.slice_mut(s![.., 2..5]).assign(&Array2::from(positions.clone()));
    let faces = Array2::from(faces);
    let columns = Positions::try_from(vertices.slice(s![.., 2..5])).unwrap();
    let mesh = Mesh::new(columns, Faces::try_from(faces.view()).unwrap());
    let map = flattener.flatten(&mesh).unwrap();
    let uvs = map.uvs_array::<f64>();
    assert_eq!(uvs, Array2::from(expected));
    let certificate = check_injective(mesh.faces, Uvs::try_from(uvs.view()).unwrap()).unwrap();
    assert!(certificate.injective);
    assert_eq!(map.uvs_array::<f32>().dim(), (positions.len(), 2));
}

#[test]
fn atlases_come_as_arrays_too() {
    let (positions, faces) = sheet(4);
    let positions = Array2::from(positions);
    let positions = Positions::try_from(positions.view()).unwrap();
    let mut unwrapper = Unwrapper::new().unwrap();
    let atlas = unwrapper.unwrap(&Surface::new(positions, &faces)).unwrap();
    assert_eq!(atlas.uvs_array::<f64>(), Array2::from(atlas.uvs::<[f64; 2]>()));
    assert_eq!(atlas.corner_uvs_array::<f32>(), Array2::from(atlas.corner_uvs::<[f32; 2]>()));
}

#[test]
fn other_layouts_are_refused_in_words() {
    let refusal =
        |array: &Array2<f32>| -> Error { Positions::try_from(array.view()).map(drop).unwrap_err() };
    assert!(refusal(&Array2::zeros((5, 2))).to_string().contains("2 columns: give 3"));
    let transposed = Array2::zeros((5, 3).f());
    assert!(refusal(&transposed).to_string().contains("as_standard_layout"));
    assert!(Positions::try_from(transposed.as_standard_layout().view()).is_ok());
    let backwards = Array2::<f32>::zeros((5, 3));
    assert!(Positions::try_from(backwards.slice(s![..;-1, ..])).is_err());
    let one = Array2::<f32>::zeros((1, 3));
    assert_eq!(Positions::try_from(one.view()).unwrap().len(), 1);
    let repeated = one.broadcast((4, 3)).unwrap();
    assert!(Positions::try_from(repeated).is_err(), "rows that lie on each other");
    assert!(Positions::try_from(Array2::<f32>::zeros((0, 3)).view()).unwrap().is_empty());
}
