//! Charts on the pages of a texture.

use beltrami::{
    Cut, ErrorKind, Pack, PackOptions, Packer, Surface, Texel, UnwrapOptions, Unwrapper, UvMesh,
};

/// So many triangles, each a chart: UVs, faces, positions.
type Confetti = (Vec<[f64; 2]>, Vec<[u32; 3]>, Vec<[f64; 3]>);

fn confetti(count: u32, size: f64) -> Confetti {
    let corners = |i: u32| {
        let x = 2.0 * f64::from(i);
        [[x, 0.0], [x + 1.0, 0.2], [x, 1.0]]
    };
    let uvs: Vec<_> = (0..count).flat_map(corners).collect();
    let faces = (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let positions = uvs.iter().map(|[u, v]| [size * u, size * v, 0.0]).collect();
    (uvs, faces, positions)
}

fn area(uvs: &[[f64; 2]], face: [u32; 3]) -> f64 {
    let [a, b, c] = face.map(|v| uvs[v as usize]);
    0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
}

#[test]
fn meshes_share_pages_at_one_density() {
    let (uvs, faces, positions) = confetti(3, 1.0);
    let (more_uvs, more_faces, more_positions) = confetti(4, 2.0);
    let mut packer = Packer::with_options(&PackOptions::new().resolution(256)).unwrap();
    let packing = packer
        .pack(&[
            UvMesh::new(&uvs, &faces).positions(&positions),
            UvMesh::new(&more_uvs, &more_faces).positions(&more_positions),
        ])
        .unwrap();
    let summary = packing.summary();
    assert!(packing.is_injective() && summary.margin >= 2.0);
    assert_eq!((summary.charts, summary.pages), (7, 1));
    assert_eq!(packing.page_utilisations(), [summary.utilisation]);
    assert_eq!(packing.chart_pages(), [0; 7]);
    let mask = packing.mask(0).unwrap();
    assert!(mask.contains(&Texel::Covered) && mask.contains(&Texel::Gutter));
    assert_eq!(packing.mask(1).unwrap_err().kind, ErrorKind::InvalidArgument);
    let (first, second) = (packer.uvs::<[f64; 2]>(0), packer.uvs::<[f64; 2]>(1));
    let ratio = area(&second, more_faces[0]) / area(&first, faces[0]);
    assert!((ratio - 4.0).abs() < 1e-9);
    assert_eq!(packer.face_charts(1), [3, 4, 5, 6]);
}

#[test]
fn charts_stay_where_they_are() {
    let (uvs, faces, _) = confetti(5, 1.0);
    let mut packer = Packer::with_options(&PackOptions::new().texels_per_unit(100.0)).unwrap();
    let _ = packer.pack(&[UvMesh::new(&uvs, &faces)]).unwrap();
    let before: Vec<[f64; 2]> = packer.uvs(0);
    packer.set_options(&PackOptions::new()).unwrap();
    let kept = [0, 0, u32::MAX, 0, 0];
    let _ = packer.pack(&[UvMesh::new(&before, &faces).kept_pages(&kept)]).unwrap();
    let after: Vec<[f64; 2]> = packer.uvs(0);
    assert_eq!((&before[..6], &before[9..]), (&after[..6], &after[9..]));
}

#[test]
fn labels_have_pages_of_their_own() {
    let (uvs, faces, _) = confetti(3, 1.0);
    let mut packer = Packer::new().unwrap();
    let labelled = UvMesh::new(&uvs, &faces).page_labels(&[8_u32, 3, 8]);
    let packing = packer.pack(&[labelled]).unwrap();
    assert_eq!(packing.chart_pages(), [1, 0, 1]);
    let short = UvMesh::new(&uvs, &faces).page_labels(&[8_u32]);
    assert_eq!(packer.pack(&[short]).unwrap_err().kind, ErrorKind::InvalidArgument);
}

#[test]
fn an_atlas_lies_on_pages() {
    let positions = [[0.0_f64, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let faces = [[0_u32, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    let surface = Surface::new(&positions, &faces);
    let options = UnwrapOptions::new().cut(Cut::Minimal).hard_angle(10.0).texels_per_unit(700.0);
    let mut unwrapper = Unwrapper::with_options(&options).unwrap();
    let atlas = unwrapper.unwrap(&surface).unwrap();
    let packing = atlas.packing().unwrap();
    assert!(packing.summary().pages > 1 && packing.summary().margin >= 2.0);
    let pages = packing.chart_pages();
    let charts: Vec<_> = atlas.face_charts().into_iter().flatten().collect();
    let of_corners = atlas.corner_pages::<u32>();
    assert!((0..12).all(|corner| of_corners[corner] as usize == pages[charts[corner / 3]]));
    assert!(atlas.charts().iter().zip(&pages).all(|(chart, page)| chart.page == *page));
    assert!(atlas.uvs::<[f64; 2]>().iter().flatten().all(|x| (0.0..=1.0).contains(x)));

    unwrapper.set_options(&UnwrapOptions::new().pack(Pack::None)).unwrap();
    assert!(unwrapper.unwrap(&surface).unwrap().packing().is_none());
}

#[test]
fn charts_are_split_at_a_price() {
    let positions: Vec<[f64; 3]> =
        (0..50_u32).map(|i| [f64::from(i / 2), f64::from(i % 2), 0.0]).collect();
    let faces: Vec<[u32; 3]> =
        (0..48).map(|i| if i % 2 == 0 { [i, i + 2, i + 1] } else { [i, i + 1, i + 2] }).collect();
    let surface = Surface::new(&positions, &faces);
    let mut unwrapper = Unwrapper::with_options(&UnwrapOptions::new().fill_weight(20.0)).unwrap();
    let summary = unwrapper.unwrap(&surface).unwrap().packing().unwrap().summary();
    assert!(summary.splits > 0 && summary.charts == 1 + summary.splits);
    let gained = summary.utilisation - summary.unsplit_utilisation;
    assert!(20.0 * gained >= summary.split_length && summary.split_length > 0.0);

    unwrapper.set_options(&UnwrapOptions::new().fill_weight(0.0)).unwrap();
    let whole = unwrapper.unwrap(&surface).unwrap().packing().unwrap().summary();
    assert_eq!((whole.splits, whole.unsplit_utilisation), (0, whole.utilisation));
    assert!((whole.utilisation - summary.unsplit_utilisation).abs() < 1e-9);
}

#[test]
fn what_cannot_be_packed_is_named() {
    let (uvs, faces, _) = confetti(3, 1.0);
    let mut packer = Packer::with_options(&PackOptions::new().texels_per_unit(1e5)).unwrap();
    assert_eq!(packer.pack(&[UvMesh::new(&uvs, &faces)]).unwrap_err().kind, ErrorKind::NoRoom);
    assert!(packer.packing().is_none());
    packer.set_options(&PackOptions::new()).unwrap();
    let odd = UvMesh::new(&uvs[..8], &faces);
    assert_eq!(packer.pack(&[odd]).unwrap_err().kind, ErrorKind::IndexOutOfRange);
    let short = UvMesh::new(&uvs, &faces).kept_pages(&[0_u32]);
    assert_eq!(packer.pack(&[short]).unwrap_err().kind, ErrorKind::InvalidArgument);
    assert_eq!(packer.pack(&[]).unwrap_err().kind, ErrorKind::Empty);
}
