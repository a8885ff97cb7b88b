//! Bakes the distortion of a map into a texture: a PNG in the layout of the UVs, in which a face is
//! grey where the map keeps lengths, red where it stretches and blue where it shrinks.
//!
//! ```sh
//! cargo run --release --example bake -- IN.obj OUT.png
//! ```

use std::env;
use std::error::Error;
use std::fs::File;
use std::io::BufWriter;
use std::process::ExitCode;

use beltrami::{measure_faces, FaceDistortion, Flattener, Mesh, View};

/// Pixels along each side of the texture, and those that stay free along its rim.
const SIZE: usize = 1024;
const MARGIN: f64 = 8.0;

const BACKGROUND: [u8; 3] = [255; 3];
const NEUTRAL: [f64; 3] = [214.0, 214.0, 214.0];
const STRETCHED: [f64; 3] = [200.0, 30.0, 30.0];
const SHRUNK: [f64; 3] = [30.0, 60.0, 200.0];

/// The area by which a face grows or shrinks that has the full colour, as log2.
const FULL_COLOUR: f64 = 1.0;

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("bake: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [input, output] = arguments.as_slice() else {
        return Err("usage: bake IN.obj OUT.png".into());
    };
    let triangles = tobj::LoadOptions { triangulate: true, ..Default::default() };
    let (models, _materials) = tobj::load_obj(input, &triangles)?;
    let [model] = models.as_slice() else {
        return Err(format!("{input} has {} objects: give one", models.len()).into());
    };
    let positions = View::<_, 3>::from_flat(&model.mesh.positions)?;
    let faces = View::<_, 3>::from_flat(&model.mesh.indices)?;
    let mesh = Mesh::new(positions, faces);

    let mut flattener = Flattener::new()?;
    let map = flattener.flatten(&mesh)?.ensure_injective()?;
    let uvs: Vec<[f64; 2]> = map.uvs();
    let distortion = measure_faces(&mesh, &uvs)?;

    let pixels = to_pixels(&uvs);
    let mut texture = vec![BACKGROUND; SIZE * SIZE];
    for (face, distortion) in faces.iter().zip(&distortion) {
        fill(&mut texture, face.map(|vertex| pixels[vertex as usize]), colour(distortion));
    }
    write_png(output, &texture)?;
    println!("{} faces, worst energy {:.3}", faces.len(), map.distortion().max);
    Ok(())
}

/// Scales and shifts the UVs into the texture, upright, in pixels.
fn to_pixels(uvs: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let bound = |axis: usize, fold: fn(f64, f64) -> f64, start: f64| {
        uvs.iter().map(|uv| uv[axis]).fold(start, fold)
    };
    let low = [0, 1].map(|axis| bound(axis, f64::min, f64::INFINITY));
    let high = [0, 1].map(|axis| bound(axis, f64::max, f64::NEG_INFINITY));
    let room = SIZE as f64 - 2.0 * MARGIN;
    let scale = room / (high[0] - low[0]).max(high[1] - low[1]);
    let pixel = |uv: &[f64; 2]| {
        let [x, y] = [0, 1].map(|axis| MARGIN + (uv[axis] - low[axis]) * scale);
        [x, SIZE as f64 - y]
    };
    uvs.iter().map(pixel).collect()
}

/// By how the area changes.
fn colour(distortion: &FaceDistortion) -> [u8; 3] {
    let change = (distortion.s1 * distortion.s2).log2() / FULL_COLOUR;
    let change = if change.is_nan() { 0.0 } else { change }; // of a face without area in 3D
    let full = if change > 0.0 { STRETCHED } else { SHRUNK };
    let part = change.abs().min(1.0);
    let mut mixed = [0; 3];
    for ((mixed, neutral), full) in mixed.iter_mut().zip(NEUTRAL).zip(full) {
        *mixed = (neutral + part * (full - neutral)) as u8;
    }
    mixed
}

/// Colours the pixels whose centres a triangle covers. In a map without flips no pixel is covered
/// twice, but on an edge.
fn fill(texture: &mut [[u8; 3]], corners: [[f64; 2]; 3], colour: [u8; 3]) {
    let range = |axis: usize| {
        let along = corners.map(|corner| corner[axis]);
        let low = along.into_iter().fold(f64::INFINITY, f64::min).floor().max(0.0);
        let high = along.into_iter().fold(0.0, f64::max).ceil();
        low as usize..(high as usize).min(SIZE)
    };
    for y in range(1) {
        for x in range(0) {
            let centre = [x as f64 + 0.5, y as f64 + 0.5];
            let sides = [0, 1, 2].map(|k| side(corners[k], corners[(k + 1) % 3], centre));
            // Clockwise, since pixels count downwards.
            if sides.iter().all(|side| *side <= 0.0) {
                texture[y * SIZE + x] = colour;
            }
        }
    }
}

/// Positive where `point` lies to the left of the line from `a` to `b`.
fn side(a: [f64; 2], b: [f64; 2], point: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (point[1] - a[1]) - (b[1] - a[1]) * (point[0] - a[0])
}

fn write_png(path: &str, texture: &[[u8; 3]]) -> Result<(), Box<dyn Error>> {
    let mut encoder =
        png::Encoder::new(BufWriter::new(File::create(path)?), SIZE as u32, SIZE as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&texture.concat())?;
    Ok(writer.finish()?)
}
