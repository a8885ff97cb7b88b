//! Loops on the threads of the caller.

mod support;

use std::panic::{catch_unwind, AssertUnwindSafe};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::Arc;

use beltrami::{Flattener, Mesh, Options, Surface, UnwrapOptions, Unwrapper};
use rayon::prelude::*;
use support::sheet;

#[test]
fn the_bits_are_the_same_at_any_number_of_jobs() {
    let (positions, faces) = sheet(60);
    let mesh = Mesh::new(&positions, &faces);
    let expected = Flattener::new().unwrap().flatten(&mesh).unwrap().uvs::<[f64; 2]>();
    for threads in [1, 2, 7] {
        let loops = Arc::new(AtomicUsize::new(0));
        let counted = Arc::clone(&loops);
        let mut flattener = Flattener::with_options(&Options::new().threads(threads)).unwrap();
        flattener.run_loops_by(move |count, job| {
            assert!(count <= threads as usize);
            counted.fetch_add(1, Ordering::Relaxed);
            (0..count).into_par_iter().for_each(job);
        });
        assert_eq!(flattener.flatten(&mesh).unwrap().uvs::<[f64; 2]>(), expected);
        assert_eq!(loops.load(Ordering::Relaxed) > 0, threads > 1);
    }
}

#[test]
fn a_panic_in_a_loop_goes_on_in_the_caller() {
    let (positions, faces) = sheet(60);
    let surface = Surface::new(&positions, &faces);
    let mut unwrapper = Unwrapper::with_options(&UnwrapOptions::new().threads(3)).unwrap();
    unwrapper.run_loops_by(|_, _| panic!("no threads today"));
    let caught = catch_unwind(AssertUnwindSafe(|| unwrapper.unwrap(&surface).is_ok()));
    assert_eq!(*caught.unwrap_err().downcast::<&str>().unwrap(), "no threads today");
    unwrapper.run_loops_by(|count, job| (0..count).for_each(job));
    assert!(unwrapper.unwrap(&surface).unwrap().certificate().injective);
}
