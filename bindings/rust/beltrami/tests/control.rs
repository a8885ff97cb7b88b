//! Progress, cancelling, panics, threads.

mod support;

use std::cell::Cell;
use std::hint;
use std::ops::ControlFlow;
use std::panic::{catch_unwind, AssertUnwindSafe};
use std::sync::mpsc;
use std::thread;

use beltrami::{
    check_boundary_with, check_injective_with, check_triangles_with, measure_faces_with,
    measure_with, CancelToken, Control, ErrorKind, Flattener, Mesh, Options, Progress,
};
use support::sheet;

fn go_on(_: Progress) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

#[test]
fn progress_comes_on_the_calling_thread_and_never_decreases() {
    let (positions, faces) = sheet(20);
    let caller = thread::current().id();
    let mut reports: Vec<Progress> = Vec::new();
    let control = Control::new().on_progress(|progress| {
        assert_eq!(thread::current().id(), caller);
        reports.push(progress);
        ControlFlow::Continue(())
    });
    let options = Options::new().threads(2).coarse_faces(200);
    let mut flattener = Flattener::with_options(&options).unwrap();
    assert!(flattener.flatten_with(&Mesh::new(&positions, &faces), control).is_ok());
    assert!(reports.windows(2).all(|pair| pair[0].fraction <= pair[1].fraction));
    assert!(reports.iter().all(|report| (0.0..=1.0).contains(&report.fraction)));
    assert!(reports.iter().any(|report| report.stage == "flatten"));
}

#[test]
fn a_break_cancels_and_the_flattener_goes_on() {
    let (positions, faces) = sheet(10);
    let mesh = Mesh::new(&positions, &faces);
    let mut flattener = Flattener::new().unwrap();
    let control = Control::new().on_progress(|progress| match progress.stage {
        "coarse" => ControlFlow::Break(()),
        _ => ControlFlow::Continue(()),
    });
    let cancelled = flattener.flatten_with(&mesh, control).map(drop).unwrap_err();
    assert_eq!(cancelled.kind, ErrorKind::Cancelled);
    assert!(flattener.flatten(&mesh).is_ok());
}

/// Tells another thread that a run is under way, and has the run wait until the token is cancelled.
fn wait_for(token: &CancelToken, started: &mpsc::Sender<()>) -> ControlFlow<()> {
    let _ = started.send(());
    while !token.is_cancelled() {
        thread::yield_now();
    }
    ControlFlow::Continue(())
}

#[test]
fn a_token_cancels_from_another_thread() {
    let (positions, faces) = sheet(6);
    let mesh = Mesh::new(&positions, &faces);
    let token = CancelToken::new();
    let (started, begin) = mpsc::channel();
    let cancelled = thread::scope(|scope| {
        let token = &token;
        scope.spawn(move || {
            begin.recv().unwrap();
            token.cancel();
        });
        let progress = |_| wait_for(token, &started);
        let control = Control::new().cancel_token(token).on_progress(progress);
        Flattener::new().unwrap().flatten_with(&mesh, control).map(drop)
    });
    assert_eq!(cancelled.unwrap_err().kind, ErrorKind::Cancelled);
    assert!(token.is_cancelled());
}

#[test]
fn a_token_that_is_cancelled_before_ends_the_run_before_it_begins() {
    let (positions, faces) = sheet(4);
    let mesh = Mesh::new(&positions, &faces);
    let token = CancelToken::new();
    token.clone().cancel();
    let called = Cell::new(false);
    let control = Control::new().cancel_token(&token).on_progress(|progress| {
        called.set(true);
        go_on(progress)
    });
    let mut flattener = Flattener::new().unwrap();
    let cancelled = flattener.flatten_with(&mesh, control).map(drop).unwrap_err();
    assert_eq!(cancelled.kind, ErrorKind::Cancelled);
    assert!(!called.get());
    assert!(flattener.run(Control::new().cancel_token(&CancelToken::new())).is_ok());
}

#[test]
fn one_token_ends_several_runs() {
    let (positions, faces) = sheet(6);
    let token = CancelToken::new();
    thread::scope(|scope| {
        let runs = [0, 1].map(|_| {
            let (started, begun) = mpsc::channel();
            let (token, mesh) = (token.clone(), Mesh::new(&positions, &faces));
            let run = scope.spawn(move || {
                let progress = |_| wait_for(&token, &started);
                let control = Control::new().cancel_token(&token).on_progress(progress);
                Flattener::new().unwrap().flatten_with(&mesh, control).map(drop)
            });
            begun.recv().unwrap();
            run
        });
        token.cancel();
        for run in runs {
            assert_eq!(run.join().unwrap().unwrap_err().kind, ErrorKind::Cancelled);
        }
    });
}

#[test]
fn the_closure_may_use_the_token_of_its_run() {
    let (positions, faces) = sheet(6);
    let token = CancelToken::new();
    let control = Control::new().cancel_token(&token).on_progress(|progress| {
        token.cancel();
        go_on(progress)
    });
    let mesh = Mesh::new(&positions, &faces);
    let cancelled = Flattener::new().unwrap().flatten_with(&mesh, control).map(drop);
    assert_eq!(cancelled.unwrap_err().kind, ErrorKind::Cancelled);
}

#[test]
fn a_token_outlives_its_flattener() {
    let (positions, faces) = sheet(4);
    let token = CancelToken::new();
    let mut flattener = Flattener::new().unwrap();
    let control = Control::new().cancel_token(&token);
    assert!(flattener.flatten_with(&Mesh::new(&positions, &faces), control).is_ok());
    drop(flattener);
    token.cancel();
}

/// Requests a little later each time, from the last report of a run to after its end, never reach
/// the run after it.
#[test]
fn a_late_request_does_not_end_the_next_run() {
    let (positions, faces) = sheet(6);
    let mut flattener = Flattener::new().unwrap();
    flattener.set_mesh(&Mesh::new(&positions, &faces)).unwrap();
    for round in 0..200 {
        let token = CancelToken::new();
        let (certifies, begin) = mpsc::channel();
        thread::scope(|scope| {
            let token = &token;
            scope.spawn(move || {
                begin.recv().unwrap();
                (0..50 * round).for_each(|_| hint::spin_loop());
                token.cancel();
            });
            let control = Control::new().cancel_token(token).on_progress(|progress| {
                if progress.stage == "certify" {
                    let _ = certifies.send(());
                }
                go_on(progress)
            });
            let _ = flattener.run(control).map(drop);
        });
        let next = flattener.run(Control::new()).map(drop);
        assert!(next.is_ok(), "round {round}: {next:?}");
    }
}

#[test]
fn a_panic_goes_round_the_library_and_on() {
    let (positions, faces) = sheet(8);
    let mesh = Mesh::new(&positions, &faces);
    let mut flattener = Flattener::new().unwrap();
    let before = flattener.flatten(&mesh).unwrap().uvs::<[f64; 2]>();
    let mut calls = 0;
    let payload = catch_unwind(AssertUnwindSafe(|| {
        let control = Control::new().on_progress(|_| {
            calls += 1;
            std::panic::panic_any("out of the closure");
        });
        flattener.run(control).map(drop)
    }))
    .unwrap_err();
    assert_eq!(payload.downcast_ref(), Some(&"out of the closure"));
    assert_eq!(calls, 1, "not called again after its panic");
    assert_eq!(flattener.parameterization().unwrap().uvs::<[f64; 2]>(), before);
    assert_eq!(flattener.run(Control::new()).unwrap().uvs::<[f64; 2]>(), before);
}

#[test]
fn a_closure_that_panics_again_when_it_is_dropped_does_so_outside_the_library() {
    struct Bomb;
    impl Drop for Bomb {
        fn drop(&mut self) {
            panic!("dropped");
        }
    }
    let (positions, faces) = sheet(4);
    let bomb = Bomb;
    let control = Control::new().on_progress(move |_| {
        let _held = &bomb;
        panic!("called");
    });
    let mut flattener = Flattener::new().unwrap();
    let mesh = Mesh::new(&positions, &faces);
    let run = AssertUnwindSafe(|| flattener.flatten_with(&mesh, control).map(drop));
    assert_eq!(catch_unwind(run).unwrap_err().downcast_ref(), Some(&"dropped"));
    assert!(flattener.run(Control::new()).is_ok());
}

#[test]
fn a_flattener_moves_to_another_thread() {
    let (positions, faces) = sheet(8);
    let mut flattener = Flattener::new().unwrap();
    flattener.set_mesh(&Mesh::new(&positions, &faces)).unwrap();
    let moved = thread::spawn(move || {
        let uvs = flattener.run(Control::new()).unwrap().uvs::<[f64; 2]>();
        (flattener, uvs)
    });
    let (flattener, uvs) = moved.join().unwrap();
    assert_eq!(flattener.parameterization().unwrap().uvs::<[f64; 2]>(), uvs);
}

#[test]
fn types_are_send_and_sync_where_they_should_be() {
    fn send<T: Send>() {}
    fn sync<T: Sync>() {}
    send::<Flattener>();
    send::<CancelToken>();
    sync::<CancelToken>();
    send::<beltrami::Error>();
    sync::<beltrami::Error>();
    send::<Options>();
    sync::<Options>();
    send::<Mesh<'_>>();
    sync::<Mesh<'_>>();
    send::<beltrami::UvsMut<'_>>();
    sync::<beltrami::UvsMut<'_>>();
}

#[test]
fn a_token_ends_checks_and_measures() {
    let (positions, faces) = sheet(10);
    let mesh = Mesh::new(&positions, &faces);
    let uvs: Vec<[f32; 2]> = positions.iter().map(|p| [p[0] as f32, p[1] as f32]).collect();
    let token = CancelToken::new();
    assert!(check_injective_with(&faces, &uvs, &token).unwrap().injective);
    token.cancel();
    let kinds = [
        check_injective_with(&faces, &uvs, &token).map(drop).unwrap_err().kind,
        check_triangles_with(&faces, &uvs, &token).map(drop).unwrap_err().kind,
        check_boundary_with(&faces, &uvs, &token).map(drop).unwrap_err().kind,
        measure_with(&mesh, &uvs, &token).map(drop).unwrap_err().kind,
        measure_faces_with(&mesh, &uvs, &token).map(drop).unwrap_err().kind,
    ];
    assert_eq!(kinds, [ErrorKind::Cancelled; 5]);
}
