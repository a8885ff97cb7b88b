//! Atlases of surfaces of every kind.

mod support;

use std::ops::ControlFlow;
use std::panic::{catch_unwind, AssertUnwindSafe};

use beltrami::{
    check_atlas, check_atlas_with, triangulate, AtlasRules, CancelToken, Control, Cut, Element,
    ErrorKind, Method, Pack, PinKind, Preset, Status, Surface, UnwrapOptions, Unwrapper, View,
    Weld,
};
use support::{sheet, single};

const CUBE: [[f64; 3]; 8] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 1.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 0.0, 1.0],
    [1.0, 1.0, 1.0],
    [0.0, 1.0, 1.0],
];
/// The sides of the cube, the upper one as two triangles.
const SIZES: [u32; 7] = [4, 3, 3, 4, 4, 4, 4];
const CORNERS: [u32; 26] =
    [3, 2, 1, 0, 4, 5, 6, 4, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7];
const TETRAHEDRON: [[f64; 3]; 4] =
    [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
const TETRAHEDRON_FACES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

fn cube() -> Surface<'static> {
    Surface::polygons(&CUBE, &SIZES, &CORNERS)
}

/// Two tetrahedra apart, one behind the other.
fn two_tetrahedra() -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let shifted = TETRAHEDRON.iter().map(|p| [p[0] + 3.0, p[1], p[2]]);
    let faces = TETRAHEDRON_FACES.iter().map(|face| face.map(|vertex| vertex + 4));
    (
        TETRAHEDRON.into_iter().chain(shifted).collect(),
        TETRAHEDRON_FACES.into_iter().chain(faces).collect(),
    )
}

#[test]
fn indices_of_any_width_are_the_same_surface() {
    let mut unwrapper = Unwrapper::new().unwrap();
    let wide = unwrapper.unwrap(&cube()).unwrap().corner_uvs::<[f64; 2]>();
    let (sizes, corners) = (SIZES.map(|size| size as u16), CORNERS.map(|corner| corner as u16));
    let narrow = Surface::polygons(&CUBE, &sizes, &corners);
    assert_eq!(unwrapper.unwrap(&narrow).unwrap().corner_uvs::<[f64; 2]>(), wide);
}

#[test]
fn polygons_get_an_atlas_whose_parts_fit_together() {
    let mut unwrapper = Unwrapper::new().unwrap();
    let atlas = unwrapper.unwrap(&cube()).unwrap().ensure_injective().unwrap();
    let summary = atlas.summary();
    assert_eq!(atlas.status(), Status::Injective);
    assert_eq!((summary.vertices, summary.faces, summary.corners), (8, 7, 26));
    assert_eq!((summary.triangles, summary.closed_components), (12, 1));
    assert!(summary.symmetric_dirichlet >= 2.0 && summary.seam_length > 0.0);
    assert!(summary.utilisation > 0.0 && summary.utilisation <= 1.0);

    let (uvs, corner_uvs) = (atlas.uvs::<[f64; 2]>(), atlas.corner_uvs::<[f64; 2]>());
    let (indices, origins) = (atlas.corner_uv_vertices::<u32>(), atlas.origins::<u64>());
    for (corner, &index) in indices.iter().enumerate() {
        assert_eq!(corner_uvs[corner], uvs[index as usize]);
        assert_eq!(origins[index as usize], u64::from(CORNERS[corner]));
    }
    let split = atlas.split(&CUBE);
    assert_eq!((split.len(), origins.len()), (summary.uv_vertices, uvs.len()));
    assert_eq!(split[indices[5] as usize], CUBE[CORNERS[5] as usize]);

    let charts = atlas.charts();
    assert_eq!(charts.len(), 1);
    assert_eq!((charts[0].triangles, charts[0].first_face, charts[0].error), (12, 0, None));
    assert_eq!(atlas.face_charts(), [Some(0); 7]);
    let area =
        |[a, b, c]: [[f64; 2]; 3]| (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    for corners in atlas.triangles::<u32>() {
        assert!(area(corners.map(|corner| corner_uvs[corner as usize])) > 0.0);
    }
    assert!(atlas.stages().iter().any(|stage| stage.name == "certify"));
    assert!(check_atlas(&cube().corner_uvs(&corner_uvs)).unwrap().injective);
    assert!(format!("{atlas:?}").contains("certificate"));
}

#[test]
fn threads_change_no_bit() {
    let (positions, faces) = two_tetrahedra();
    let surface = Surface::new(&positions, &faces);
    let uvs = |threads| {
        let options = UnwrapOptions::new().threads(threads);
        let mut unwrapper = Unwrapper::with_options(&options).unwrap();
        unwrapper.unwrap(&surface).unwrap().corner_uvs::<[f64; 2]>()
    };
    assert_eq!(uvs(1), uvs(2));
}

#[test]
fn single_precision_is_judged_as_such() {
    let (positions, faces) = sheet(8);
    let positions = single(&positions);
    let mut unwrapper = Unwrapper::with_options(&UnwrapOptions::new().float32(true)).unwrap();
    let surface = Surface::new(&positions, &faces);
    let atlas = unwrapper.unwrap(&surface).unwrap().ensure_float32_injective().unwrap();
    assert_eq!(atlas.certificate(), atlas.float32_certificate());
    let uvs: Vec<[f32; 2]> = atlas.corner_uvs();
    assert!(check_atlas(&surface.corner_uvs(&uvs)).unwrap().injective);
    // A disk has no seams: its UV vertices are its vertices.
    assert_eq!(atlas.summary().seam_length, 0.0);
    assert_eq!(atlas.uvs::<[f32; 2]>().len(), positions.len());
}

#[test]
fn charts_part_where_they_are_told_to() {
    let mut unwrapper = Unwrapper::new().unwrap();
    let mut charts = |surface: &Surface<'_>, options: &UnwrapOptions| {
        unwrapper.set_options(options).unwrap();
        let atlas = unwrapper.unwrap(surface).unwrap().ensure_injective().unwrap();
        (atlas.charts().len(), atlas.corner_uvs::<[f64; 2]>())
    };
    let plain = UnwrapOptions::new().cut(Cut::Minimal);
    assert_eq!(charts(&cube(), &plain).0, 1);
    assert_eq!(charts(&cube().face_labels(&[0_u64, 1, 1, 0, 0, 0, 0]), &plain).0, 2);
    let rim = [[4_u32, 5], [5, 6], [6, 7], [4, 7], [0, 6]]; // the last is no edge
    assert_eq!(charts(&cube().seams(&rim), &plain).0, 2);
    let (sides, uvs) = charts(&cube(), &plain.clone().hard_angle(45.0));
    assert_eq!(sides, 6);
    let islands = UnwrapOptions::new().cut(Cut::Islands);
    assert_eq!(charts(&cube().corner_uvs(&uvs), &islands).0, 6);
    assert_eq!(charts(&cube().corner_uvs(&uvs), &plain).0, 1);

    let soup: Vec<_> = CORNERS.iter().map(|&vertex| CUBE[vertex as usize]).collect();
    let corners: Vec<u32> = (0..26).collect();
    let soup = Surface::polygons(&soup, &SIZES, &corners);
    assert_eq!(charts(&soup, &plain).0, 1);
    assert_eq!(charts(&soup, &plain.weld(Weld::Off)).0, 7);
}

#[test]
fn seams_are_found_for_a_target_and_make_the_same_charts_again() {
    let mut unwrapper = Unwrapper::new().unwrap();
    let atlas = unwrapper.unwrap(&cube()).unwrap();
    assert_eq!(atlas.reached_target(), Some(true));
    let (seams, charts) = (atlas.seams::<u32>(), atlas.face_charts());
    assert_eq!(seams.len(), atlas.summary().seams);
    assert!(seams.is_sorted() && seams.iter().all(|[a, b]| a < b));

    unwrapper.set_options(&UnwrapOptions::new().cut(Cut::Given)).unwrap();
    let again = unwrapper.unwrap(&cube().seams(&seams)).unwrap();
    assert_eq!(again.seams::<u32>(), seams);
    assert_eq!(again.face_charts(), charts);
    assert_eq!(again.reached_target(), None);

    let budget = UnwrapOptions::new().preset(Preset::Lightmap).seam_budget(0.01);
    unwrapper.set_options(&budget).unwrap();
    assert_eq!(unwrapper.unwrap(&cube()).unwrap().reached_target(), Some(false));
}

#[test]
fn paint_and_materials_are_taken_and_looked_at() {
    let mut unwrapper = Unwrapper::new().unwrap();
    let mut paint = [1.0_f32; 8];
    let materials = [0_u32, 1, 1, 0, 0, 0, 0];
    let painted = cube().vertex_paint(&paint).materials(&materials);
    let painted_edge = painted.edge_paint(&[[0_u32, 1]], &[0.1_f64]);
    assert!(unwrapper.unwrap(&painted_edge).unwrap().is_injective());
    let unequal = painted.edge_paint(&[[0_u32, 1], [1, 2]], &[0.1_f64]);
    assert_eq!(unwrapper.unwrap(&unequal).unwrap_err().kind, ErrorKind::InvalidArgument);
    let short = cube().vertex_paint(&paint[1..]);
    assert_eq!(unwrapper.unwrap(&short).unwrap_err().kind, ErrorKind::InvalidArgument);
    paint[5] = -1.0;
    let error = unwrapper.unwrap(&cube().vertex_paint(&paint)).unwrap_err();
    assert_eq!((error.kind, error.element), (ErrorKind::InvalidArgument, Some(Element::Vertex(5))));
}

#[test]
fn densities_scale_charts() {
    let (positions, faces) = two_tetrahedra();
    let densities = [1.0_f32, 1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 2.0];
    let options = UnwrapOptions::new().pack(Pack::None);
    let mut unwrapper = Unwrapper::with_options(&options).unwrap();
    let surface = Surface::new(&positions, &faces).densities(&densities);
    let charts = unwrapper.unwrap(&surface).unwrap().charts();
    let width = |chart: usize| charts[chart].uv_box[1][0] - charts[chart].uv_box[0][0];
    assert_eq!((charts[0].density, charts[1].density), (1.0, 2.0));
    assert!((width(1) / width(0) - 2.0).abs() < 1e-9);
}

#[test]
fn pins_are_met_or_named() {
    let positions = [[0.0_f64, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.25], [0.0, 1.0, 0.0]];
    let faces = [[0_u32, 1, 2], [0, 2, 3]];
    let (corners, uvs) = ([0_u32, 1, 2], [[0.1, 0.2], [1.3, 0.0], [1.1, 1.2]]);
    let mut unwrapper = Unwrapper::new().unwrap();
    let surface = Surface::new(&positions, &faces);
    let atlas = unwrapper.unwrap(&surface.pins(&corners, &uvs)).unwrap();
    assert!(atlas.certificate().injective);
    assert_eq!(atlas.corner_uvs::<[f64; 2]>()[..3], uvs);
    let turned = [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]];
    let error = unwrapper.unwrap(&surface.pins(&corners, &turned)).unwrap_err();
    assert_eq!(error.kind, ErrorKind::Pins);
    assert!(matches!(error.element, Some(Element::Corner(0..=2))), "{error}");
    let error = unwrapper.unwrap(&surface.pins(&corners, &turned[..2])).unwrap_err();
    assert_eq!(error.kind, ErrorKind::InvalidArgument);
}

#[test]
fn charts_become_rectangles_and_edges_straight() {
    // Two rows of three squares, bent along the middle column.
    let height = [0.0, 0.0, 0.4, 0.4];
    let positions: Vec<[f64; 3]> = (0..12)
        .map(|v| {
            [f64::from(v % 4) + 0.2 * f64::from(v / 4), f64::from(v / 4), height[v as usize % 4]]
        })
        .collect();
    let mut faces = Vec::new();
    for a in [0_u32, 1, 2, 4, 5, 6] {
        faces.extend([[a, a + 1, a + 5], [a, a + 5, a + 4]]);
    }
    let options = UnwrapOptions::new().cut(Cut::Minimal).pack(Pack::None);
    let mut unwrapper = Unwrapper::with_options(&options).unwrap();
    let surface = Surface::new(&positions, &faces);
    let uv_of = |atlas: &beltrami::Atlas<'_>, vertex: u32| {
        let corner = faces.iter().flatten().position(|&v| v == vertex).unwrap();
        atlas.corner_uvs::<[f64; 2]>()[corner]
    };
    let (rectangle, corners) = ([0_u32], [[0_u32, 3, 11, 8]]);
    let atlas =
        unwrapper.unwrap(&surface.rectangles(&rectangle).rectangle_corners(&corners)).unwrap();
    assert!(atlas.certificate().injective);
    assert_eq!(uv_of(&atlas, 0)[1], uv_of(&atlas, 3)[1]);
    assert_eq!(uv_of(&atlas, 3)[0], uv_of(&atlas, 11)[0]);
    let (edges, kinds) = ([[0_u32, 1], [1, 2], [2, 3]], [PinKind::V as u32; 3]);
    let atlas = unwrapper.unwrap(&surface.straight_edges(&edges, &kinds)).unwrap();
    assert!((1..4).all(|v| uv_of(&atlas, v)[1] == uv_of(&atlas, 0)[1]));
    let error = unwrapper.unwrap(&surface.straight_edges(&edges, &kinds[..2])).unwrap_err();
    assert_eq!(error.kind, ErrorKind::InvalidArgument);
}

#[test]
fn faces_without_area_get_a_point() {
    let faces = [&TETRAHEDRON_FACES[..], &[[0, 0, 1]]].concat();
    let mut unwrapper = Unwrapper::new().unwrap();
    let atlas = unwrapper.unwrap(&Surface::new(&TETRAHEDRON, &faces)).unwrap();
    assert!(atlas.is_injective());
    assert_eq!(atlas.summary().repeated_faces, 1);
    assert_eq!(atlas.face_charts()[4], None);
    assert_eq!(atlas.face_charts()[3], Some(0));
}

#[test]
fn views_are_read_and_written_where_they_lie() {
    struct Corner {
        vertex: u32,
        uv: [f32; 2],
    }
    let mut corners: Vec<_> =
        CORNERS.iter().map(|&vertex| Corner { vertex, uv: [f32::NAN; 2] }).collect();
    let vertices: Vec<[u32; 1]> = corners.iter().map(|corner| [corner.vertex]).collect();
    let vertices = View::from(&vertices[..]);
    let mut unwrapper = Unwrapper::new().unwrap();
    let surface = Surface::polygons(&CUBE, &SIZES, vertices);
    let atlas = unwrapper.unwrap(&surface).unwrap();
    let room = beltrami::ViewMut::from_field(&mut corners, |corner| &mut corner.uv).unwrap();
    atlas.write_corner_uvs(room).unwrap();
    let written: Vec<_> = corners.iter().map(|corner| corner.uv).collect();
    assert_eq!(written, atlas.corner_uvs::<[f32; 2]>());
    let mut short = vec![[0.0_f32; 2]; 5];
    for error in [atlas.write_corner_uvs(&mut short), atlas.write_uvs(&mut short)] {
        assert_eq!(error.unwrap_err().kind, ErrorKind::InvalidArgument);
    }
}

#[test]
fn what_does_not_fit_together_is_refused() {
    let mut unwrapper = Unwrapper::new().unwrap();
    let (short, uvs) = ([1_u32; 3], [[0.0_f32; 2]; 7]);
    for (surface, words) in [
        (cube().face_labels(&short), "there are 3 face labels for 7 faces: give one per face"),
        (cube().densities(&[1.0_f32]), "there are 1 densities for 7 faces"),
        (cube().corner_uvs(&uvs), "there are 7 corner UVs for 26 corners: give one per corner"),
        (Surface::polygons(&CUBE, &SIZES, &CORNERS[..25]), "corner"),
        (Surface::polygons(&CUBE, &[2_u32, 3], &CORNERS[..5]), "corners"),
        (cube().densities(&[0.0; 7]), "density of face 0"),
    ] {
        let error = unwrapper.unwrap(&surface).unwrap_err();
        assert_eq!(error.kind, ErrorKind::InvalidArgument);
        assert!(error.message.contains(words), "{error}");
    }
    assert_eq!(
        triangulate::<u32>(&Surface::polygons(&CUBE, &[2_u32, 3], &CORNERS[..5])).unwrap_err().kind,
        ErrorKind::InvalidArgument
    );
    assert_eq!(check_atlas(&cube()).unwrap_err().kind, ErrorKind::InvalidArgument);
}

#[test]
fn errors_name_the_element() {
    let mut unwrapper = Unwrapper::new().unwrap();
    let mut corners = CORNERS;
    corners[9] = 8;
    let wrong = Surface::polygons(&CUBE, &SIZES, &corners);
    let error = unwrapper.unwrap(&wrong).unwrap_err();
    assert_eq!((error.kind, error.element), (ErrorKind::IndexOutOfRange, Some(Element::Face(2))));
    let mut positions = CUBE;
    positions[6][1] = f64::INFINITY;
    let error = unwrapper.unwrap(&Surface::polygons(&positions, &SIZES, &CORNERS)).unwrap_err();
    assert_eq!((error.kind, error.element), (ErrorKind::NonFinite, Some(Element::Vertex(6))));
    assert!(unwrapper.atlas().is_none());
    let flat = [[0.0; 3]; 8];
    let error = unwrapper.unwrap(&Surface::polygons(&flat, &SIZES, &CORNERS)).unwrap_err();
    assert_eq!(error.kind, ErrorKind::ZeroArea);
    let none: [[u32; 3]; 0] = [];
    let error = unwrapper.unwrap(&Surface::new(&CUBE, &none)).unwrap_err();
    assert_eq!(error.kind, ErrorKind::Empty);
}

#[test]
fn a_failure_leaves_the_last_atlas() {
    let mut unwrapper = Unwrapper::new().unwrap();
    let uvs = unwrapper.unwrap(&cube()).unwrap().uvs::<[f64; 2]>();
    let flat = [[0.0; 3]; 8];
    unwrapper.unwrap(&Surface::polygons(&flat, &SIZES, &CORNERS)).unwrap_err();
    assert_eq!(unwrapper.atlas().unwrap().uvs::<[f64; 2]>(), uvs);
    let refused = unwrapper.set_options(&UnwrapOptions::new().hard_angle(190.0)).unwrap_err();
    assert_eq!(refused.kind, ErrorKind::InvalidArgument);
    assert_eq!(unwrapper.unwrap(&cube()).unwrap().uvs::<[f64; 2]>(), uvs);
}

#[test]
fn an_atlas_that_is_not_injective_is_a_result() {
    let (positions, faces) = support::spiral(60, 2.2, 0.05);
    let options = UnwrapOptions::new().method(Method::Bff).cut(Cut::Minimal);
    let mut unwrapper = Unwrapper::with_options(&options).unwrap();
    let atlas = unwrapper.unwrap(&Surface::new(&positions, &faces)).unwrap();
    assert_eq!(atlas.status(), Status::NotInjective);
    assert_eq!(atlas.charts()[0].status, Status::NotInjective);
    assert!(atlas.certificate().overlaps > 0);
    let error = atlas.ensure_injective().unwrap_err();
    assert_eq!(error.kind, ErrorKind::NotInjective);
    assert!(matches!(error.element, Some(Element::Face(_))));
    assert!(atlas.ensure_float32_injective().is_err());
}

#[test]
fn overlaps_are_listed_and_mirror_images_allowed() {
    let (positions, faces) = two_tetrahedra();
    let mut unwrapper = Unwrapper::new().unwrap();
    let mut uvs = unwrapper.unwrap(&Surface::new(&positions, &faces)).unwrap().corner_uvs();
    let token = CancelToken::new();
    let judge = |uvs: &[[f64; 2]], rules: &AtlasRules| {
        check_atlas_with(&Surface::new(&positions, &faces).corner_uvs(uvs), rules, &token).unwrap()
    };
    let rules = AtlasRules::new().most_pairs(100);
    assert!(judge(&uvs, &rules).certificate.injective);
    for corner in &mut uvs[..12] {
        *corner = [-100.0 - corner[0], corner[1]];
    }
    assert_eq!(judge(&uvs, &rules).certificate.negative, 4);
    let mirrored = judge(&uvs, &rules.allow_mirrored(true)).certificate;
    assert!(mirrored.injective);
    assert_eq!((mirrored.mirrored_charts, mirrored.mirrored_faces), (1, 4));
    for corner in 0..12 {
        uvs[corner] = uvs[corner + 12];
    }
    let found = judge(&uvs, &rules);
    assert!(!found.certificate.injective);
    assert_eq!(found.pairs.len(), found.certificate.overlaps);
    assert!(found.pairs.contains(&[0, 4]) || found.pairs.contains(&[4, 0]));
    assert_eq!(judge(&uvs, &rules.most_pairs(1)).pairs.len(), 1);
    token.cancel();
    let surface = Surface::new(&positions, &faces).corner_uvs(&uvs);
    let error = check_atlas_with(&surface, &rules, &token).unwrap_err();
    assert_eq!(error.kind, ErrorKind::Cancelled);
}

#[test]
fn polygons_are_cut_into_triangles() {
    let found = triangulate::<u64>(&cube()).unwrap();
    assert_eq!(found.triangles.len(), 12);
    assert_eq!(found.triangles[2], [4, 5, 6]);
    assert_eq!(found.first_repeating, None);
    let twice = triangulate::<u32>(&Surface::polygons(&CUBE, &[4_u32], &[0_u32, 1, 2, 1])).unwrap();
    assert_eq!(twice.first_repeating, Some(0));
}

#[test]
fn runs_are_watched_and_ended() {
    let (positions, faces) = sheet(12);
    let surface = Surface::new(&positions, &faces);
    let mut unwrapper = Unwrapper::new().unwrap();
    let mut fractions = Vec::new();
    let control = Control::new().on_progress(|progress| {
        fractions.push(progress.fraction);
        ControlFlow::Continue(())
    });
    assert!(unwrapper.unwrap_with(&surface, control).unwrap().is_injective());
    assert!(fractions.windows(2).all(|pair| pair[0] <= pair[1]));
    assert_eq!(fractions.last(), Some(&1.0));

    let control = Control::new().on_progress(|_| ControlFlow::Break(()));
    let error = unwrapper.unwrap_with(&surface, control).unwrap_err();
    assert_eq!(error.kind, ErrorKind::Cancelled);

    let token = CancelToken::new();
    let control = Control::new().cancel_token(&token).on_progress(|_| {
        token.cancel();
        ControlFlow::Continue(())
    });
    let error = unwrapper.unwrap_with(&surface, control).unwrap_err();
    assert_eq!(error.kind, ErrorKind::Cancelled);
    let control = Control::new().cancel_token(&token);
    let error = unwrapper.unwrap_with(&surface, control).unwrap_err();
    assert_eq!(error.kind, ErrorKind::Cancelled);

    let control = Control::new().on_progress(|_| panic!("in the closure"));
    let payload = catch_unwind(AssertUnwindSafe(|| {
        let _ = unwrapper.unwrap_with(&surface, control).map(drop);
    }));
    assert_eq!(payload.unwrap_err().downcast_ref(), Some(&"in the closure"));
    assert!(unwrapper.unwrap(&surface).unwrap().is_injective());
}

#[test]
fn an_unwrapper_may_move_to_another_thread() {
    let mut unwrapper = Unwrapper::new().unwrap();
    let here = unwrapper.unwrap(&cube()).unwrap().uvs::<[f64; 2]>();
    let there = std::thread::spawn(move || unwrapper.unwrap(&cube()).unwrap().uvs::<[f64; 2]>());
    assert_eq!(there.join().unwrap(), here);
}
