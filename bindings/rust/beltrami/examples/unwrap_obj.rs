//! Unwraps an OBJ file of any kind and writes it again with texture coordinates, polygons as they
//! were.
//!
//! ```sh
//! cargo run --release --example unwrap_obj -- IN.obj OUT.obj [--hard-angle 60] ...
//! ```
//!
//! Every option of unwrapping is an option here.

use std::env;
use std::error::Error;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::process::ExitCode;

use beltrami::{Surface, UnwrapOptions, Unwrapper, View, OPTIONS};

const USAGE: &str = "usage: unwrap_obj IN.obj OUT.obj [--OPTION VALUE]...";

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("unwrap_obj: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [input, output, options @ ..] = arguments.as_slice() else {
        return Err(usage().into());
    };
    let mut unwrapper = Unwrapper::with_options(&parse_options(options)?)?;

    let (models, _materials) = tobj::load_obj(input, &tobj::LoadOptions::default())?;
    let [model] = models.as_slice() else {
        return Err(format!("{input} has {} objects: give one", models.len()).into());
    };
    let mesh = &model.mesh;
    let positions = View::<_, 3>::from_flat(&mesh.positions)?;
    // tobj leaves the sizes out where all faces are triangles.
    let triangles = vec![3; mesh.indices.len() / 3];
    let sizes = if mesh.face_arities.is_empty() { &triangles } else { &mesh.face_arities };

    let surface = Surface::polygons(positions, sizes, &mesh.indices);
    let atlas = unwrapper.unwrap(&surface)?;
    eprintln!("{}", atlas.status().advice());
    let summary = atlas.summary();
    println!("{} charts of {} faces", summary.charts, summary.faces);
    println!("symmetric Dirichlet energy {:.4} (2 is an isometry)", summary.symmetric_dirichlet);
    println!("{:.0} % of the page are covered", 100.0 * summary.utilisation);

    write_obj(output, &positions, sizes, &mesh.indices, &atlas.uvs(), &atlas.corner_uv_vertices())?;
    // What is shipped is single precision, so that is what must be injective.
    if !atlas.float32_certificate().injective {
        return Err("the atlas is not injective".into());
    }
    Ok(())
}

fn parse_options(arguments: &[String]) -> Result<UnwrapOptions, Box<dyn Error>> {
    let mut options = UnwrapOptions::new().float32(true);
    for pair in arguments.chunks(2) {
        match pair {
            [flag, value] if flag.starts_with("--") => options = options.set(&flag[2..], value)?,
            _ => return Err(usage().into()),
        }
    }
    Ok(options)
}

fn usage() -> String {
    let options = OPTIONS.iter().filter(|option| option.unwraps);
    let options = options.map(|option| format!("\n  --{} {}", option.name, option.summary));
    USAGE.to_owned() + &options.collect::<String>()
}

fn write_obj(
    path: &str,
    positions: &View<'_, f32, 3>,
    sizes: &[u32],
    vertices: &[u32],
    uvs: &[[f32; 2]],
    uv_vertices: &[u32],
) -> io::Result<()> {
    let mut out = BufWriter::new(File::create(path)?);
    for [x, y, z] in positions.iter() {
        writeln!(out, "v {x} {y} {z}")?;
    }
    for [u, v] in uvs {
        writeln!(out, "vt {u} {v}")?;
    }
    let mut corners = vertices.iter().zip(uv_vertices);
    for &size in sizes {
        write!(out, "f")?;
        for (vertex, uv) in corners.by_ref().take(size as usize) {
            write!(out, " {}/{}", vertex + 1, uv + 1)?;
        }
        writeln!(out)?;
    }
    out.flush()
}
