//! The safe interface beside the C functions themselves: the same bits.

mod support;

use std::ffi::c_void;
use std::mem::size_of;
use std::ptr;

use beltrami::{
    check_injective, measure, measure_faces, Delaunay, Energy, Flatten, Flattener, Mesh, Method,
    Options, OPTIONS,
};
use beltrami_sys as sys;
use support::{sheet, single, Surface};

/// What C says of a run, floating-point numbers as their bits.
#[derive(Debug, PartialEq)]
struct Outcome {
    status: i32,
    uvs: Vec<u64>,
    float32_uvs: Vec<u32>,
    faces: Vec<u32>,
    face_energies: Vec<u64>,
    energies: [u64; 3],
    positive: u64,
    flips_before_repair: u64,
}

fn bits(numbers: impl IntoIterator<Item = f64>) -> Vec<u64> {
    numbers.into_iter().map(f64::to_bits).collect()
}

fn float32_bits(numbers: impl IntoIterator<Item = f32>) -> Vec<u32> {
    numbers.into_iter().map(f32::to_bits).collect()
}

fn buffer<T>(items: &[T], scalar: i32) -> sys::beltrami_buffer {
    sys::beltrami_buffer { data: items.as_ptr().cast(), type_: scalar, ..Default::default() }
}

fn raw_mesh((positions, faces): &Surface) -> sys::beltrami_mesh {
    sys::beltrami_mesh {
        struct_size: size_of::<sys::beltrami_mesh>() as u32,
        vertex_count: positions.len() as u64,
        face_count: faces.len() as u64,
        positions: buffer(positions, sys::BELTRAMI_F64),
        indices: buffer(faces, sys::BELTRAMI_U32),
        ..Default::default()
    }
}

/// `count` numbers that `get` writes to the memory that it is given.
fn read<T: Copy + Default>(count: usize, get: impl FnOnce(*mut c_void) -> i32) -> Vec<T> {
    let mut numbers = vec![T::default(); count];
    assert_eq!(get(numbers.as_mut_ptr().cast()), sys::BELTRAMI_OK);
    numbers
}

fn key(name: &str) -> i32 {
    OPTIONS.iter().position(|option| option.name == name).unwrap() as i32
}

/// By the C functions alone.
fn c_outcome(surface: &Surface, options: &[(&str, i64)]) -> Outcome {
    let (vertices, faces) = (surface.0.len(), surface.1.len());
    let mut energy = sys::beltrami_energy {
        struct_size: size_of::<sys::beltrami_energy>() as u32,
        ..Default::default()
    };
    let mut certificate = sys::beltrami_certificate {
        struct_size: size_of::<sys::beltrami_certificate>() as u32,
        ..Default::default()
    };
    let mut result = sys::beltrami_result {
        struct_size: size_of::<sys::beltrami_result>() as u32,
        ..Default::default()
    };
    let mut context = ptr::null_mut();
    // SAFETY: the mesh is borrowed, its counts are those of its arrays; `read` gives room for as
    // many numbers as each function writes; the structs have the sizes that they say.
    unsafe {
        assert_eq!(sys::beltrami_create(&mut context), sys::BELTRAMI_OK);
        for &(name, value) in options {
            assert_eq!(sys::beltrami_set_int(context, key(name), value), sys::BELTRAMI_OK);
        }
        assert_eq!(sys::beltrami_set_mesh(context, &raw_mesh(surface)), sys::BELTRAMI_OK);
        let status = sys::beltrami_run(context, None, ptr::null_mut());
        assert_eq!(sys::beltrami_get_energy(context, &mut energy), sys::BELTRAMI_OK);
        assert_eq!(sys::beltrami_get_certificate(context, &mut certificate), sys::BELTRAMI_OK);
        assert_eq!(sys::beltrami_get_result(context, &mut result), sys::BELTRAMI_OK);
        let uvs = |out, scalar| sys::beltrami_get_uvs(context, out, scalar, 0);
        let triangles = |out| sys::beltrami_get_faces(context, out, sys::BELTRAMI_U32, 0);
        let outcome = Outcome {
            status,
            uvs: bits(read(2 * vertices, |out| uvs(out, sys::BELTRAMI_F64))),
            float32_uvs: float32_bits(read(2 * vertices, |out| uvs(out, sys::BELTRAMI_F32))),
            faces: read(3 * faces, triangles),
            face_energies: bits(read(faces, |out| {
                sys::beltrami_get_face_energies(context, out, 0)
            })),
            energies: [energy.symmetric_dirichlet, energy.symmetric_arap, energy.max]
                .map(f64::to_bits),
            positive: certificate.positive,
            flips_before_repair: result.flips_before_repair,
        };
        sys::beltrami_destroy(context);
        outcome
    }
}

/// By the safe interface.
fn safe_outcome((positions, faces): &Surface, options: &Options) -> Outcome {
    let mut flattener = Flattener::with_options(options).unwrap();
    let map = flattener.flatten(&Mesh::new(positions, faces)).unwrap();
    let energy = map.distortion();
    Outcome {
        status: map.status().raw(),
        uvs: bits(map.uvs::<[f64; 2]>().concat()),
        float32_uvs: float32_bits(map.uvs::<[f32; 2]>().concat()),
        faces: map.faces::<u32>().concat(),
        face_energies: bits(map.face_energies()),
        energies: [energy.symmetric_dirichlet, energy.symmetric_arap, energy.max].map(f64::to_bits),
        positive: map.certificate().orientations.positive as u64,
        flips_before_repair: map.summary().flips_before_repair as u64,
    }
}

#[test]
fn a_run_has_the_bits_of_the_c_functions() {
    let surface = sheet(20);
    let coarse = || Options::new().coarse_faces(200);
    let faces = ("coarse-faces", 200);
    let cases: [(Options, &[(&str, i64)]); 8] = [
        (Options::new(), &[]),
        (coarse(), &[faces]),
        (coarse().unit_square(true).float32(true), &[faces, ("unit-square", 1), ("float32", 1)]),
        (coarse().energy(Energy::SymmetricArap).threads(2), &[faces, ("energy", 1)]),
        (coarse().energy(Energy::ExponentialDirichlet), &[faces, ("energy", 2)]),
        (
            coarse().flatten(Flatten::Dirichlet).refine(true),
            &[faces, ("flatten", 1), ("refine", 1)],
        ),
        (coarse().delaunay(Delaunay::On), &[faces, ("delaunay", 1)]),
        (Options::new().method(Method::Bff), &[("method", 4)]),
    ];
    for (options, raw) in &cases {
        assert_eq!(safe_outcome(&surface, options), c_outcome(&surface, raw), "{options:?}");
    }
}

#[test]
fn checks_and_measures_have_the_bits_of_the_c_functions() {
    let surface = sheet(20);
    let (positions, faces) = &surface;
    let mesh = Mesh::new(positions, faces);
    let flat: Vec<[f32; 2]> = single(positions).iter().map(|&[x, y, z]| [x + 2.0 * z, y]).collect();
    let uvs = buffer(&flat, sys::BELTRAMI_F32);
    let mut certificate = sys::beltrami_certificate {
        struct_size: size_of::<sys::beltrami_certificate>() as u32,
        ..Default::default()
    };
    let mut energy = sys::beltrami_energy {
        struct_size: size_of::<sys::beltrami_energy>() as u32,
        ..Default::default()
    };
    let raw = raw_mesh(&surface);
    // SAFETY: the arrays are borrowed, the structs have the sizes that they say, and there is room
    // for four numbers per face.
    let per_face = unsafe {
        sys::beltrami_check_injective(&raw, &uvs, &mut certificate);
        sys::beltrami_measure(&raw, &uvs, &mut energy, ptr::null_mut());
        read(4 * faces.len(), |out| sys::beltrami_measure_faces(&raw, &uvs, out, 0))
    };
    let judged = check_injective(faces, &flat).unwrap();
    assert!(judged.orientations.negative > 0, "a case with flips");
    assert_eq!(judged.orientations.negative as u64, certificate.negative);
    assert_eq!(judged.crossings.count as u64, certificate.boundary_crossings);
    let measured = measure(&mesh, &flat).unwrap();
    assert_eq!(
        bits([measured.symmetric_dirichlet, measured.symmetric_arap, measured.max]),
        bits([energy.symmetric_dirichlet, energy.symmetric_arap, energy.max])
    );
    let of_faces = measure_faces(&mesh, &flat).unwrap();
    let numbers =
        of_faces.iter().flat_map(|f| [f.s1, f.s2, f.symmetric_dirichlet, f.symmetric_arap]);
    assert_eq!(bits(numbers), bits(per_face));
}
