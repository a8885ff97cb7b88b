//! Flattens a disk-like OBJ file and writes it again with one texture coordinate per vertex.
//!
//! ```sh
//! cargo run --release --example flatten_obj -- IN.obj OUT.obj [--energy symmetric-arap] ...
//! ```
//!
//! Every option of the library is an option here. The vertices that are written are those of tobj,
//! which counts them in the order in which the faces name them; beltrami leaves that as it is.

use std::env;
use std::error::Error;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::ops::ControlFlow;
use std::process::ExitCode;

use beltrami::{Control, Flattener, Mesh, Options, Progress, View, OPTIONS};

const USAGE: &str = "usage: flatten_obj IN.obj OUT.obj [--OPTION VALUE]...";

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("flatten_obj: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [input, output, options @ ..] = arguments.as_slice() else {
        return Err(usage().into());
    };
    let options = parse_options(options)?;

    let triangles = tobj::LoadOptions { triangulate: true, ..Default::default() };
    let (models, _materials) = tobj::load_obj(input, &triangles)?;
    let [model] = models.as_slice() else {
        return Err(format!("{input} has {} objects: give one", models.len()).into());
    };
    // tobj hands out numbers in a row; they are borrowed as they lie.
    let positions = View::<_, 3>::from_flat(&model.mesh.positions)?;
    let faces = View::<_, 3>::from_flat(&model.mesh.indices)?;

    let mut flattener = Flattener::with_options(&options)?;
    let control = Control::new().on_progress(show);
    let map = flattener.flatten_with(&Mesh::new(positions, faces), control)?;
    eprintln!("\r\x1b[K{}", map.status().advice());
    let energy = map.distortion();
    println!("symmetric Dirichlet energy {:.4} (2 is an isometry)", energy.symmetric_dirichlet);
    println!("symmetric ARAP energy      {:.4} (0 is an isometry)", energy.symmetric_arap);

    // What is shipped is single precision, so that is what must be injective.
    let certificate = map.float32_certificate();
    println!("{} faces positive of {}", certificate.orientations.positive, faces.len());
    write_obj(output, &positions, &faces, &map.uvs())?;
    if !certificate.injective {
        return Err("the map is not injective".into());
    }
    Ok(())
}

fn show(progress: Progress) -> ControlFlow<()> {
    eprint!("\r\x1b[K{:3.0} % {}", 100.0 * progress.fraction, progress.stage);
    ControlFlow::Continue(())
}

fn parse_options(arguments: &[String]) -> Result<Options, Box<dyn Error>> {
    let mut options = Options::new();
    for pair in arguments.chunks(2) {
        match pair {
            [flag, value] if flag.starts_with("--") => options = options.set(&flag[2..], value)?,
            _ => return Err(usage().into()),
        }
    }
    Ok(options)
}

fn usage() -> String {
    let options = OPTIONS.iter().filter(|option| option.flattens);
    let options = options.map(|option| format!("\n  --{} {}", option.name, option.summary));
    USAGE.to_owned() + &options.collect::<String>()
}

fn write_obj(
    path: &str,
    positions: &View<'_, f32, 3>,
    faces: &View<'_, u32, 3>,
    uvs: &[[f32; 2]],
) -> io::Result<()> {
    let mut out = BufWriter::new(File::create(path)?);
    for [x, y, z] in positions.iter() {
        writeln!(out, "v {x} {y} {z}")?;
    }
    for [u, v] in uvs {
        writeln!(out, "vt {u} {v}")?;
    }
    for [a, b, c] in faces.iter().map(|face| face.map(|vertex| vertex + 1)) {
        writeln!(out, "f {a}/{a} {b}/{b} {c}/{c}")?;
    }
    out.flush()
}
