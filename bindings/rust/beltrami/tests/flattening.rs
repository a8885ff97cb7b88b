//! Flattening, its results and its failures.

mod support;

use std::mem::size_of;

use beltrami::{
    check_boundary, check_injective, check_triangles, measure, measure_faces, Control, Delaunay,
    Element, Error, ErrorKind, Flattener, Injectivity, Mesh, Method, Options, Status, View,
};
use support::{sheet, single, spiral};

fn failure(positions: &[[f64; 3]], faces: &[[u32; 3]]) -> Error {
    let mut flattener = Flattener::new().unwrap();
    flattener.flatten(&Mesh::new(positions, faces)).map(drop).unwrap_err()
}

/// Equal but for rounding.
fn assert_near(left: f64, right: f64) {
    assert!((left - right).abs() < 1e-12 * left.abs().max(1.0), "{left} and {right}");
}

#[test]
fn a_sheet_becomes_an_injective_map_of_low_distortion() {
    let (positions, faces) = sheet(20);
    let mut flattener = Flattener::new().unwrap();
    let map = flattener.flatten(&Mesh::new(&positions, &faces)).unwrap();
    assert_eq!(map.status(), Status::Injective);
    assert!(map.is_injective());
    let map = map.ensure_injective().unwrap().ensure_float32_injective().unwrap();
    let uvs = map.uvs::<[f64; 2]>();
    assert!(check_injective(&faces, &uvs).unwrap().injective);
    assert_eq!(map.certificate(), check_injective(&faces, &uvs).unwrap());
    assert!(map.float32_certificate().injective);
    assert!((2.0..2.2).contains(&map.distortion().symmetric_dirichlet));
    assert_eq!(map.faces::<u32>(), faces);
    assert_eq!(map.faces::<u64>()[5], faces[5].map(u64::from));
    assert!(format!("{map:?}").starts_with("Parameterization { status: Injective, certificate: "));
}

#[test]
fn a_run_needs_no_more_memory_than_it_is_allowed() {
    let (positions, faces) = sheet(20);
    let mut flattener = Flattener::new().unwrap();
    assert_eq!(flattener.estimate_memory().unwrap_err().kind, ErrorKind::InvalidState);
    flattener.set_mesh(&Mesh::new(&positions, &faces)).unwrap();
    let bytes = flattener.estimate_memory().unwrap();
    flattener.set_options(&Options::new().memory_limit(bytes - 1)).unwrap();
    let refused = flattener.run(Control::new()).unwrap_err();
    assert_eq!(refused.kind, ErrorKind::OutOfMemory);
    assert!(refused.to_string().contains("memory-limit"), "{refused}");
    flattener.set_options(&Options::new().memory_limit(bytes)).unwrap();
    assert!(flattener.run(Control::new()).unwrap().is_injective());
    let beyond = Options::new().memory_limit(u64::MAX);
    assert_eq!(flattener.set_options(&beyond).unwrap_err().kind, ErrorKind::InvalidArgument);
}

#[test]
fn energies_of_faces_are_those_that_are_measured() {
    let (positions, faces) = sheet(12);
    let mesh = Mesh::new(&positions, &faces);
    let mut flattener = Flattener::new().unwrap();
    let map = flattener.flatten(&mesh).unwrap();
    let uvs = map.uvs::<[f64; 2]>();
    let (ours, theirs) = (measure(&mesh, &uvs).unwrap(), map.distortion());
    assert_near(ours.symmetric_dirichlet, theirs.symmetric_dirichlet);
    assert_eq!((ours.worst_face, ours.left_out), (theirs.worst_face, theirs.left_out));
    for (face, energy) in measure_faces(&mesh, &uvs).unwrap().iter().zip(map.face_energies()) {
        let (a, b) = (face.s1 * face.s1, face.s2 * face.s2);
        assert_near(face.symmetric_dirichlet, energy);
        assert_near(face.symmetric_dirichlet, 0.5 * (a + b + 1.0 / a + 1.0 / b));
        assert!(face.s1 >= face.s2 && face.s2 > 0.0);
    }
}

#[test]
fn flips_and_missing_area_show_in_the_distortion_of_faces() {
    let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [2.0, 0.0, 0.0]];
    let faces = [[0_u32, 1, 2], [0, 1, 3]];
    let uvs = [[0.0_f32, 0.0], [1.0, 0.0], [0.0, -2.0], [0.0, 1.0]];
    let measured = measure_faces(&Mesh::new(&positions, &faces), &uvs).unwrap();
    assert_near(measured[0].s1, 2.0);
    assert_near(measured[0].s2, -1.0);
    assert_eq!(measured[0].symmetric_dirichlet, f64::INFINITY);
    assert_eq!(measured[0].symmetric_arap, f64::INFINITY);
    assert!(measured[1].s1.is_nan() && measured[1].symmetric_arap.is_nan());
}

#[test]
fn single_precision_is_the_rounding_of_double_precision() {
    let (positions, faces) = sheet(12);
    let mut flattener = Flattener::new().unwrap();
    let map = flattener.flatten(&Mesh::new(&single(&positions), &faces)).unwrap();
    assert_eq!(map.summary().float32_moves, 0);
    let rounded: Vec<_> = map.uvs::<[f64; 2]>().iter().map(|uv| uv.map(|x| x as f32)).collect();
    assert_eq!(map.uvs::<[f32; 2]>(), rounded);
}

#[test]
fn the_result_does_not_depend_on_how_the_mesh_lies_in_memory() {
    #[allow(dead_code)]
    struct Vertex {
        position: [f64; 3],
        colour: [u8; 4],
    }
    let (positions, faces) = sheet(10);
    let vertices: Vec<_> =
        positions.iter().map(|&position| Vertex { position, colour: [0; 4] }).collect();
    let wide: Vec<_> = faces.iter().map(|face| face.map(u64::from)).collect();
    let flat: Vec<_> = faces.iter().flatten().copied().collect();
    let mut flattener = Flattener::new().unwrap();
    let mut flatten = |mesh: Mesh<'_>| flattener.flatten(&mesh).unwrap().uvs::<[f64; 2]>();
    let expected = flatten(Mesh::new(&positions, &faces));
    let fields = View::from_field(&vertices, |vertex| &vertex.position).unwrap();
    assert_eq!(expected, flatten(Mesh::new(fields, &wide)));
    assert_eq!(expected, flatten(Mesh::new(&positions, View::from_flat(&flat).unwrap())));
}

#[test]
fn uvs_are_written_where_the_caller_wants_them() {
    let (positions, faces) = sheet(6);
    let mut flattener = Flattener::new().unwrap();
    let map = flattener.flatten(&Mesh::new(&positions, &faces)).unwrap();
    let uvs = map.uvs::<[f32; 2]>();
    let mut vertices = vec![(7_u8, [9.0_f32; 2]); positions.len()];
    let room = beltrami::ViewMut::from_field(&mut vertices, |vertex| &mut vertex.1).unwrap();
    map.write_uvs(room).unwrap();
    assert!(vertices.iter().zip(&uvs).all(|(vertex, uv)| *vertex == (7, *uv)));

    let mut short = vec![[0.0_f32; 2]; positions.len() - 1];
    let refused = map.write_uvs(&mut short).unwrap_err();
    assert_eq!(refused.kind, ErrorKind::InvalidArgument);
    assert!(short.iter().all(|uv| *uv == [0.0; 2]));
}

#[test]
fn unused_vertices_lie_in_the_origin() {
    let (mut positions, faces) = sheet(4);
    positions.push([5.0, 5.0, 5.0]);
    let mut flattener = Flattener::new().unwrap();
    let map = flattener.flatten(&Mesh::new(&positions, &faces)).unwrap();
    assert_eq!(map.summary().unreferenced_vertices, 1);
    assert_eq!(map.uvs::<[f64; 2]>().last(), Some(&[0.0, 0.0]));
}

#[test]
fn a_map_that_is_not_injective_is_a_result_and_an_error_on_demand() {
    let (positions, faces) = spiral(60, 1.5, 0.02);
    let options = Options::new().injectivity(Injectivity::Local);
    let mut flattener = Flattener::with_options(&options).unwrap();
    let mesh = Mesh::new(&positions, &faces);
    let map = flattener.flatten(&mesh).unwrap();
    assert_eq!(map.status(), Status::NotInjective);
    assert!(!map.is_injective());
    assert!(map.status().advice().len() > 20);
    let uvs = map.uvs::<[f64; 2]>();
    let refused = map.ensure_injective().map(drop).unwrap_err();
    assert_eq!(refused.kind, ErrorKind::NotInjective);
    assert!(check_triangles(&faces, &uvs).unwrap().all_positive());
    let crossings = check_boundary(&faces, &uvs).unwrap();
    assert!(crossings.count > 0 && crossings.first.is_some());
    let first = map.certificate().crossings.first;
    assert_eq!(refused.element, first.map(|[vertex, _]| Element::Vertex(vertex)));
    let refused = map.ensure_float32_injective().map(drop).unwrap_err();
    assert_eq!(refused.kind, ErrorKind::NotInjective);

    flattener.set_options(&Options::new()).unwrap();
    let map = flattener.flatten(&mesh).unwrap().ensure_injective().unwrap();
    assert_eq!(map.certificate().crossings.count, 0);
}

#[test]
fn an_optimisation_that_stops_early_is_injective_and_says_so() {
    let (positions, faces) = sheet(10);
    let options = Options::new().method(Method::Cm).max_iterations(1).tolerance(0.0);
    let mut flattener = Flattener::with_options(&options).unwrap();
    let map = flattener.flatten(&Mesh::new(&positions, &faces)).unwrap();
    assert_eq!(map.status(), Status::NotConverged);
    assert!(map.ensure_injective().is_ok());
}

#[test]
fn float32_delivers_numbers_that_single_precision_holds() {
    let (positions, faces) = sheet(8);
    let mut flattener = Flattener::with_options(&Options::new().float32(true)).unwrap();
    let map = flattener.flatten(&Mesh::new(&positions, &faces)).unwrap();
    let numbers = map.uvs::<[f64; 2]>().concat();
    assert!(numbers.iter().all(|&x| f64::from(x as f32) == x));
}

#[test]
fn a_map_beyond_single_precision_is_no_injective_one_in_it() {
    let (mut positions, faces) = sheet(6);
    positions.iter_mut().flatten().for_each(|x| *x *= 1e50);
    let mesh = Mesh::new(&positions, &faces);
    let mut flattener = Flattener::with_options(&Options::new().float32(true)).unwrap();
    let map = flattener.flatten(&mesh).unwrap();
    assert_eq!(map.status(), Status::NotInjectiveFloat32);
    let refused = map.ensure_injective().map(drop).unwrap_err();
    assert_eq!(refused.kind, ErrorKind::NotInjectiveFloat32);
    flattener.set_options(&Options::new()).unwrap();
    let map = flattener.flatten(&mesh).unwrap().ensure_injective().unwrap();
    let refused = map.ensure_float32_injective().map(drop).unwrap_err();
    assert_eq!(refused.kind, ErrorKind::NotInjectiveFloat32);
}

#[test]
fn with_delaunay_the_faces_are_those_of_the_triangulation() {
    let (mut positions, faces) = sheet(10);
    for position in &mut positions {
        position[0] *= 6.0; // long triangles, for it to flip
    }
    let options = Options::new().delaunay(Delaunay::On).coarse_faces(50);
    let mut flattener = Flattener::with_options(&options).unwrap();
    let map = flattener.flatten(&Mesh::new(&positions, &faces)).unwrap();
    let own = map.faces::<u32>();
    assert!(map.summary().delaunay_flips > 0);
    assert_ne!(own, faces);
    assert_eq!(check_injective(&own, &map.uvs::<[f64; 2]>()).unwrap(), map.certificate());
}

#[test]
fn a_failure_names_its_kind_and_element() {
    let (positions, mut faces) = sheet(3);
    faces[7] = [0, 1, 99];
    let error = failure(&positions, &faces);
    assert_eq!((error.kind, error.element), (ErrorKind::IndexOutOfRange, Some(Element::Face(7))));
    assert!(error.to_string().contains("99"), "{error}");

    let (mut positions, faces) = sheet(3);
    positions[4][1] = f64::NAN;
    let error = failure(&positions, &faces);
    assert_eq!((error.kind, error.element), (ErrorKind::NonFinite, Some(Element::Vertex(4))));

    let closed = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]];
    let error = failure(&[[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]], &closed);
    assert_eq!((error.kind, error.element), (ErrorKind::Closed, None));
    assert_eq!(failure(&[], &[]).kind, ErrorKind::Empty);
}

#[test]
fn a_failed_mesh_leaves_the_last_result() {
    let (positions, faces) = sheet(5);
    let mut flattener = Flattener::new().unwrap();
    assert!(flattener.parameterization().is_none());
    assert_eq!(
        flattener.run(Default::default()).map(drop).unwrap_err().kind,
        ErrorKind::InvalidState
    );
    let uvs = flattener.flatten(&Mesh::new(&positions, &faces)).unwrap().uvs::<[f64; 2]>();
    assert!(flattener.flatten(&Mesh::new(&positions[..3], &faces)).is_err());
    assert_eq!(flattener.parameterization().unwrap().uvs::<[f64; 2]>(), uvs);
}

#[test]
fn refused_options_leave_the_old_ones() {
    let (positions, faces) = sheet(5);
    let mesh = Mesh::new(&positions, &faces);
    let unit_square = Options::new().unit_square(true);
    let mut flattener = Flattener::with_options(&unit_square).unwrap();
    let refused = flattener.set_options(&Options::new().method(Method::Tutte).threads(0));
    let refused = refused.unwrap_err();
    assert_eq!(refused.kind, ErrorKind::InvalidArgument);
    assert!(refused.to_string().contains("threads"), "{refused}");
    let kept = flattener.flatten(&mesh).unwrap().uvs::<[f64; 2]>();
    let mut same = Flattener::with_options(&unit_square).unwrap();
    assert_eq!(same.flatten(&mesh).unwrap().uvs::<[f64; 2]>(), kept);
    assert!(kept.iter().flatten().all(|x| (0.0..=1.0).contains(x)));
}

#[test]
fn checks_refuse_what_is_no_map() {
    let faces = [[0_u32, 1, 2], [0, 2, 3]];
    let uvs = [[0.0_f32, 0.0], [1.0, 0.0], [1.0, f32::NAN], [0.0, 1.0]];
    let error = check_injective(&faces, &uvs).unwrap_err();
    assert_eq!((error.kind, error.element), (ErrorKind::NonFinite, Some(Element::Vertex(2))));
    assert!(error.to_string().contains("vertex 2"), "{error}");
    let error = check_triangles(&faces, &uvs[..2]).unwrap_err();
    assert_eq!((error.kind, error.element), (ErrorKind::IndexOutOfRange, Some(Element::Face(0))));
}

#[test]
fn measures_refuse_what_is_no_map() {
    let (positions, faces) = sheet(2);
    let refusal = |positions: &[[f64; 3]], faces: &[[u32; 3]], uvs: &[[f64; 2]]| {
        let mesh = Mesh::new(positions, faces);
        let error = measure(&mesh, uvs).unwrap_err();
        assert_eq!(measure_faces(&mesh, uvs).unwrap_err(), error);
        (error.kind, error.element)
    };
    let flat: Vec<_> = positions.iter().map(|&[x, y, _]| [x, y]).collect();
    assert_eq!(refusal(&positions, &faces, &flat[1..]), (ErrorKind::InvalidArgument, None));
    assert_eq!(refusal(&positions, &[], &flat), (ErrorKind::Empty, None));
    let beyond = refusal(&positions, &[[0, 1, 2], [0, 2, 9]], &flat);
    assert_eq!(beyond, (ErrorKind::IndexOutOfRange, Some(Element::Face(1))));
    let mut holed = flat.clone();
    holed[3][0] = f64::INFINITY;
    let infinite = refusal(&positions, &faces, &holed);
    assert_eq!(infinite, (ErrorKind::NonFinite, Some(Element::Vertex(3))));
    let mut torn = positions.clone();
    torn[5][2] = f64::NAN;
    assert_eq!(refusal(&torn, &faces, &flat), (ErrorKind::NonFinite, None));
}

#[test]
fn stages_come_in_their_order_and_counts_are_those_of_the_mesh() {
    let (positions, faces) = sheet(10);
    let mut flattener = Flattener::with_options(&Options::new().coarse_faces(50)).unwrap();
    let map = flattener.flatten(&Mesh::new(&positions, &faces)).unwrap();
    let names: Vec<_> = map.stages().iter().map(|stage| stage.name).collect();
    assert!(names.contains(&"flatten") && names.last() == Some(&"certify"), "{names:?}");
    let summary = map.summary();
    assert_eq!((summary.vertices, summary.faces, summary.boundary_edges), (121, 200, 40));
    assert!(summary.area > 100.0 && summary.seconds >= 0.0);
}

#[test]
fn every_status_of_the_header_has_a_kind_of_its_own_name() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../abi/constants.txt");
    let constants = std::fs::read_to_string(path).unwrap();
    let errors = constants.lines().filter_map(|line| line.strip_prefix("BELTRAMI_E_"));
    let mut seen = 0;
    for (name, number) in errors.filter_map(|line| line.split_once(' ')) {
        let status: i32 = number.trim().trim_start_matches("= ").parse().unwrap();
        let kind = KINDS.iter().find(|kind| kind.status() == status).unwrap_or_else(|| {
            panic!("there is no ErrorKind for BELTRAMI_E_{name}, {status}");
        });
        assert_eq!(format!("{kind:?}").to_uppercase(), name.replace('_', ""));
        seen += 1;
    }
    assert!(seen >= 20, "{seen} statuses in {path}");
}

/// All kinds that stand for a failure in the library.
const KINDS: [ErrorKind; 22] = [
    ErrorKind::NoRoom,
    ErrorKind::Pins,
    ErrorKind::InvalidArgument,
    ErrorKind::OutOfMemory,
    ErrorKind::AbiMismatch,
    ErrorKind::Unsupported,
    ErrorKind::InvalidState,
    ErrorKind::Cancelled,
    ErrorKind::Internal,
    ErrorKind::Empty,
    ErrorKind::IndexOutOfRange,
    ErrorKind::NonFinite,
    ErrorKind::RepeatedVertex,
    ErrorKind::NonManifoldEdge,
    ErrorKind::NonManifoldVertex,
    ErrorKind::Orientation,
    ErrorKind::Components,
    ErrorKind::Closed,
    ErrorKind::Boundaries,
    ErrorKind::Genus,
    ErrorKind::ZeroArea,
    ErrorKind::Solver,
];

#[test]
fn the_library_describes_itself() {
    let (major, minor, _) = beltrami::version();
    assert_eq!((major, minor), (0, 1));
    assert!(beltrami::build_info().starts_with("beltrami 0.1."));
    assert!(beltrami::has("scaffold:own") != beltrami::has("scaffold:cgal"));
    assert!(!beltrami::has("nonsense") && !beltrami::has("with\0nul"));
}

#[test]
fn a_face_distortion_is_the_four_numbers_of_the_library() {
    assert_eq!(size_of::<beltrami::FaceDistortion>(), 32);
}
