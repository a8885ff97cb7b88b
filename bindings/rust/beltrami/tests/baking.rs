//! Images for new UVs.

use std::ops::ControlFlow;

use beltrami::{Bake, CancelToken, Control, ErrorKind, Image, PixelKind, Wrap};

const SQUARE: [[f64; 2]; 6] =
    [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

fn noise(count: usize) -> Vec<u16> {
    let mut state = 1_u32;
    let mut next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 16) as u16
    };
    (0..count).map(|_| next()).collect()
}

#[test]
fn the_same_uvs_give_the_same_image_at_any_number_of_threads() {
    let pixels = noise(64 * 64 * 3);
    let images = [Image::new(&pixels, 64, 64, 3).unwrap()];
    for kind in [PixelKind::Linear, PixelKind::Srgb] {
        for threads in [1, 2] {
            let bake = Bake::new(&images, &SQUARE, &SQUARE).resolution(64).pixels(kind);
            let baked = bake.threads(threads).bake().unwrap();
            assert_eq!(baked.pixels, pixels);
            assert_eq!((baked.texels, baked.without_source), (64 * 64, 0));
        }
    }
}

#[test]
fn pages_and_wraps_say_what_is_read() {
    let (first, second) = ([10_u8; 4], [20_u8; 4]);
    let images = [Image::new(&first, 2, 2, 1).unwrap(), Image::new(&second, 2, 2, 1).unwrap()];
    let beyond = SQUARE.map(|[u, v]| [u + 5.0, v]);
    let baked = Bake::new(&images, &beyond, &SQUARE)
        .wrap(Wrap::Clamp, Wrap::Mirror)
        .old_pages(&[0_u32, 1])
        .new_pages(&[1_u32, 0], 2)
        .resolution(4)
        .bake()
        .unwrap();
    assert_eq!(baked.pixels[..16], [20; 16]);
    assert_eq!(baked.pixels[16..], [10; 16]);
}

#[test]
fn a_token_and_a_closure_end_it() {
    let pixels = [0_u8; 4];
    let images = [Image::new(&pixels, 2, 2, 1).unwrap()];
    let bake = Bake::new(&images, &SQUARE, &SQUARE).resolution(256);
    let token = CancelToken::new();
    token.cancel();
    let controls = [
        Control::new().cancel_token(&token),
        Control::new().on_progress(|_| ControlFlow::Break(())),
    ];
    for control in controls {
        assert_eq!(bake.bake_with(control).unwrap_err().kind, ErrorKind::Cancelled);
    }
}

#[test]
fn what_is_wrong_is_said() {
    let pixels = [0_u8; 4];
    assert_eq!(Image::new(&pixels, 2, 2, 3).unwrap_err().kind, ErrorKind::InvalidArgument);
    let images = [Image::new(&pixels, 2, 2, 1).unwrap()];
    let kind = |bake: Bake<'_, u8>| bake.bake().unwrap_err().kind;
    assert_eq!(kind(Bake::new(&images, &SQUARE[..3], &SQUARE)), ErrorKind::InvalidArgument);
    let bake = Bake::new(&images, &SQUARE, &SQUARE);
    assert_eq!(kind(bake.resolution(0)), ErrorKind::InvalidArgument);
    assert_eq!(kind(bake.old_pages(&[0_u32])), ErrorKind::InvalidArgument);
    assert_eq!(kind(bake.old_pages(&[0_u32, 1])), ErrorKind::InvalidArgument);
    assert_eq!(kind(bake.pixels(PixelKind::Normals)), ErrorKind::InvalidArgument);
    assert_eq!(kind(Bake::new(&[], &SQUARE, &SQUARE)), ErrorKind::InvalidArgument);
    let nowhere = SQUARE.map(|_| [f64::NAN; 2]);
    assert_eq!(kind(Bake::new(&images, &SQUARE, &nowhere)), ErrorKind::NonFinite);
    assert_eq!(kind(Bake::new(&images, &nowhere, &SQUARE)), ErrorKind::InvalidArgument);
}

/// The unit square at a height.
fn floor(height: f64) -> [[f64; 3]; 6] {
    SQUARE.map(|[u, v]| [u, v, height])
}

#[test]
fn a_cage_sees_what_is_too_far_for_the_nearest_place() {
    let pixels = noise(32 * 32);
    let images = [Image::new(&pixels, 32, 32, 1).unwrap()];
    let (below, above) = (floor(0.0), floor(0.3));
    let bake = Bake::new(&images, &SQUARE, &SQUARE)
        .positions(&below)
        .source_positions(&above)
        .resolution(32);
    assert_eq!(bake.bake().unwrap_err().kind, ErrorKind::InvalidArgument);
    assert_eq!(bake.cage(0.5).bake().unwrap().pixels, pixels);
}

#[test]
fn a_floor_sees_the_sky_and_what_hangs_above_it_hides_it() {
    let images = [Image::new(&[0.0_f32], 1, 1, 1).unwrap()];
    let (below, above) = (floor(0.0), floor(0.3));
    let bake = Bake::new(&images, &SQUARE, &SQUARE)
        .pixels(PixelKind::Occlusion)
        .positions(&below)
        .rays(64)
        .resolution(16);
    assert!(bake.bake().unwrap().pixels.iter().all(|&open| open == 1.0));
    let hidden = bake.source_positions(&above).cage(0.0);
    assert!(hidden.bake().is_err(), "nothing of the source is near");
    assert!(bake.rays(0).bake().is_err());
}
