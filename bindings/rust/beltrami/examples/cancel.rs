//! A run on a thread of its own, and a user who gives up after a tenth of a second.
//!
//! ```sh
//! cargo run --release --example cancel
//! ```

use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

use beltrami::{CancelToken, Control, ErrorKind, Flattener, Mesh};

const PATIENCE: Duration = Duration::from_millis(100);
const FRAME: Duration = Duration::from_millis(16);

fn main() {
    let token = CancelToken::new();
    let permille = Arc::new(AtomicU32::new(0));
    let job = thread::spawn({
        let (token, permille) = (token.clone(), Arc::clone(&permille));
        move || flatten_terrain(&token, &permille)
    });

    let start = Instant::now();
    let mut requested = None;
    while !job.is_finished() {
        println!("frame: {:4.1} %", f64::from(permille.load(Ordering::Relaxed)) / 10.0);
        thread::sleep(FRAME);
        if requested.is_none() && start.elapsed() > PATIENCE {
            token.cancel(); // returns at once
            requested = Some(Instant::now());
        }
    }
    let waited = requested.map_or(Duration::ZERO, |instant| instant.elapsed());
    match job.join().expect("the job does not panic") {
        Err(error) if error.kind == ErrorKind::Cancelled => {
            println!("cancelled, {} ms after the request", waited.as_millis());
        }
        Err(error) => panic!("{error}"),
        Ok(vertices) => println!("{vertices} vertices were faster than the user's patience"),
    }
}

/// The job: leaves its progress behind and looks for nothing.
fn flatten_terrain(token: &CancelToken, permille: &AtomicU32) -> Result<usize, beltrami::Error> {
    let (positions, faces) = terrain(400);
    let control = Control::new().cancel_token(token).on_progress(|progress| {
        permille.store((1000.0 * progress.fraction) as u32, Ordering::Relaxed);
        std::ops::ControlFlow::Continue(())
    });
    let mut flattener = Flattener::new()?;
    let map = flattener.flatten_with(&Mesh::new(&positions, &faces), control)?;
    Ok(map.uvs::<[f32; 2]>().len())
}

fn terrain(cells: u32) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let side = cells + 1;
    let vertex = |k: u32| {
        let (x, y) = ((k % side) as f32, (k / side) as f32);
        [x, y, 20.0 * (0.05 * x).sin() * (0.07 * y).cos()]
    };
    let square = |k: u32| {
        let a = k / cells * side + k % cells;
        [[a, a + 1, a + side + 1], [a, a + side + 1, a + side]]
    };
    ((0..side * side).map(vertex).collect(), (0..cells * cells).flat_map(square).collect())
}
