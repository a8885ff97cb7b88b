//! Unwraps OBJ files side by side on the threads of rayon, and the loops of one run on the same.
//!
//! ```sh
//! cargo run --release --example with_rayon -- A.obj B.obj ...
//! ```

use std::env;
use std::error::Error;
use std::process::ExitCode;

use beltrami::{Surface, UnwrapOptions, Unwrapper, View};
use rayon::prelude::*;

type AnyError = Box<dyn Error + Send + Sync>;

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("with_rayon: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), AnyError> {
    let paths: Vec<String> = env::args().skip(1).collect();
    let [first, ..] = paths.as_slice() else {
        return Err("usage: with_rayon A.obj B.obj ...".into());
    };
    // Many meshes: each is a job, and each thread has an unwrapper of its own.
    let injective = paths
        .par_iter()
        .map_init(Unwrapper::new, |unwrapper, path| -> Result<usize, AnyError> {
            let unwrapper = unwrapper.as_mut().map_err(|error| error.to_string())?;
            let uvs = unwrap(unwrapper, path)?;
            Ok(usize::from(uvs.is_some()))
        })
        .try_reduce(|| 0, |a, b| Ok(a + b))?;

    // One mesh: its loops are shared by the threads of rayon. The bits stay the same.
    let alone = unwrap(&mut Unwrapper::new()?, first)?;
    let threads = rayon::current_num_threads();
    let options = UnwrapOptions::new().threads(u32::try_from(threads)?.max(2));
    let mut unwrapper = Unwrapper::with_options(&options)?;
    unwrapper.run_loops_by(|count, job| (0..count).into_par_iter().for_each(job));
    if unwrap(&mut unwrapper, first)? != alone {
        return Err("the bits depend on the threads".into());
    }
    println!(
        "{injective} of {} meshes are injective, and the loops of a run have the same bits",
        paths.len()
    );
    Ok(())
}

/// The UVs of the corners, where they are injective.
fn unwrap(unwrapper: &mut Unwrapper, path: &str) -> Result<Option<Vec<[f32; 2]>>, AnyError> {
    let load = tobj::LoadOptions { triangulate: true, ..Default::default() };
    let (models, _materials) = tobj::load_obj(path, &load)?;
    let [model] = models.as_slice() else {
        return Err(format!("{path} has {} objects: give one", models.len()).into());
    };
    let positions = View::<_, 3>::from_flat(&model.mesh.positions)?;
    let faces = View::<_, 3>::from_flat(&model.mesh.indices)?;
    let atlas = unwrapper.unwrap(&Surface::new(positions, faces))?;
    Ok(atlas.float32_certificate().injective.then(|| atlas.corner_uvs()))
}
