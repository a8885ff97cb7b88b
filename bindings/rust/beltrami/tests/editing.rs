//! Sessions of edits: what edits do, what is refused, how they are ended.

mod support;

use std::ops::ControlFlow;
use std::panic::{catch_unwind, AssertUnwindSafe};
use std::sync::mpsc;
use std::thread;

use beltrami::{
    Budget, CancelToken, ChartFlags, Control, Editor, ErrorKind, PinKind, Status, Surface,
    UnwrapOptions, View,
};
use support::{sheet, single};

/// A mapped sheet of `cells` by `cells` squares.
fn editor(cells: u32) -> Editor {
    let (positions, faces) = sheet(cells);
    let mut editor = Editor::new(&Surface::new(&positions, &faces)).unwrap();
    assert_eq!(editor.update().unwrap(), Status::Injective);
    editor
}

/// The edges of a line across such a sheet, in its middle.
fn across(cells: u32) -> Vec<[u32; 2]> {
    let (side, middle) = (cells + 1, cells / 2);
    (0..cells).map(|j| [middle + j * side, middle + (j + 1) * side]).collect()
}

fn ids(editor: &Editor) -> Vec<u64> {
    editor.charts().iter().map(|chart| chart.id).collect()
}

#[test]
fn seams_open_and_close_and_what_was_saved_comes_back() {
    let mut editor = editor(10);
    let before = editor.corner_uvs::<[f64; 2]>();
    let mark = editor.save().unwrap();
    editor.open_seams(&across(10)).unwrap();
    assert_eq!(editor.update().unwrap(), Status::Injective);
    let charts = editor.charts();
    assert_eq!(charts.len(), 2);
    assert_eq!(charts.iter().map(|chart| chart.triangles).sum::<usize>(), 200);
    assert!(charts.iter().all(|chart| !chart.due && !chart.locked && chart.scale > 0.0));
    let of_faces = editor.face_charts();
    for chart in &charts {
        assert_eq!(of_faces[chart.first_face], Some(chart.id));
    }
    editor.close_seams(&across(10)).unwrap();
    assert_eq!(editor.update().unwrap(), Status::Injective);
    assert_eq!((editor.summary().charts, editor.opened::<u32>().len()), (1, 0));
    editor.restore(mark).unwrap();
    assert_eq!(editor.corner_uvs::<[f64; 2]>(), before);
    editor.forget(mark).unwrap();
    assert_eq!(editor.restore(mark).unwrap_err().kind, ErrorKind::InvalidArgument);
}

#[test]
fn changes_are_what_moved_and_pins_are_met() {
    let mut editor = editor(8);
    let mut uvs = editor.corner_uvs::<[f64; 2]>();
    let place = [uvs[0][0] + 0.5, uvs[0][1] - 0.25];
    editor.set_pins(&[0_u32], &[place]).unwrap();
    assert_eq!(editor.update().unwrap(), Status::Injective);
    let changes = editor.changes::<[f64; 2]>();
    assert!(!changes.corners.is_empty());
    for (&corner, &uv) in changes.corners.iter().zip(&changes.uvs) {
        uvs[corner] = uv;
    }
    assert_eq!(editor.corner_uvs::<[f64; 2]>(), uvs);
    assert_eq!(uvs[0], place);
    let mut room = vec![9.0_f32; 3 * uvs.len()];
    let strided = beltrami::ViewMut::strided(&mut room, 1, 3, uvs.len()).unwrap();
    editor.write_corner_uvs(strided).unwrap();
    assert!(room.chunks(3).zip(&uvs).all(|(r, uv)| r[0] == 9.0 && r[1] == uv[0] as f32));
    assert_eq!(
        editor.write_corner_uvs(&mut room_for(uvs.len() - 1)).unwrap_err().kind,
        ErrorKind::InvalidArgument
    );
}

fn room_for(len: usize) -> Vec<[f64; 2]> {
    vec![[0.0; 2]; len]
}

#[test]
fn pins_slide() {
    let mut editor = editor(6);
    let along = [[1.0_f64, 1.0]];
    editor.set_pins(&[0_u32], &[[7.0_f64, 3.0]]).unwrap();
    editor.set_pin_kinds(&[PinKind::Line as u32], &along).unwrap();
    assert_eq!(editor.update().unwrap(), Status::Injective);
    let [u, v] = editor.corner_uvs::<[f64; 2]>()[0];
    assert!((u - v - 4.0).abs() < 1e-9);
    let kinds = [PinKind::V as u32; 2];
    let error = editor.set_pin_kinds(&kinds, &[[0.0_f64, 0.0]; 2]).unwrap_err();
    assert_eq!(error.kind, ErrorKind::InvalidArgument);
}

#[test]
fn locked_and_unselected_faces_stay() {
    let mut editor = editor(8);
    let before = editor.corner_uvs::<[f64; 2]>();
    editor.lock(&ids(&editor), true).unwrap();
    editor.renew(&ids(&editor), true).unwrap();
    editor.update().unwrap_or(Status::Injective).raw();
    assert_eq!(editor.corner_uvs::<[f64; 2]>(), before);
    assert!(editor.charts()[0].locked);
    editor.lock(&ids(&editor), false).unwrap();
    editor.select(&[0_u64, 1]).unwrap();
    editor.update().unwrap().raw();
    let after = editor.corner_uvs::<[f64; 2]>();
    assert_eq!(after[after.len() - 6..], before[before.len() - 6..]);
}

#[test]
fn charts_keep_what_their_flags_say() {
    let mut editor = editor(6);
    editor.open_seams(&across(6)).unwrap();
    editor.update().unwrap().raw();
    let flags = ChartFlags { align: true, stack: true, ..ChartFlags::default() };
    editor.set_flags(&ids(&editor), flags).unwrap();
    assert!(editor.charts().iter().all(|chart| chart.due && chart.flags == flags));
    editor.update().unwrap().raw();
    assert_eq!(editor.pack().unwrap(), Status::Injective);
    assert!(editor.charts().iter().all(|chart| chart.stacked_on != Some(chart.id)));
    assert_eq!(editor.set_flags(&[99], flags).unwrap_err().kind, ErrorKind::InvalidArgument);
}

#[test]
fn charts_are_packed_all_or_some() {
    let (positions, faces) = sheet(6);
    let options = UnwrapOptions::new().float32(true).resolution(256);
    let positions = single(&positions);
    let surface = Surface::new(&positions, &faces);
    let mut editor = Editor::with_options(&surface, &options, Control::new()).unwrap();
    assert_eq!(editor.pack().unwrap_err().kind, ErrorKind::InvalidState);
    editor.open_seams(&across(6)).unwrap();
    assert_eq!(editor.update().unwrap(), Status::Injective);
    assert_eq!(editor.pack().unwrap(), Status::Injective);
    assert!(editor.corner_uvs::<[f32; 2]>().iter().flatten().all(|x| (0.0..=1.0).contains(x)));
    let first = ids(&editor)[0];
    assert_eq!(editor.pack_with(Some(&[first]), Control::new()).unwrap(), Status::Injective);
    assert!(editor.check().unwrap().injective);
    let none = editor.pack_with(Some(&[]), Control::new()).unwrap_err();
    assert_eq!(none.kind, ErrorKind::InvalidArgument);
    editor.set_options(&UnwrapOptions::new().resolution(64)).unwrap();
    assert_eq!(editor.pack().unwrap(), Status::Injective);
}

#[test]
fn a_budget_ends_an_update_and_the_next_goes_on() {
    let mut editor = editor(16);
    editor.open_seams(&across(16)[..8]).unwrap();
    let budget = Budget::new().steps(1);
    let mut updates = 0;
    while editor.update_with(budget, Control::new()).unwrap() == Status::NotConverged {
        updates += 1;
        assert!(updates < 100);
    }
    assert_eq!(editor.summary().due, 0);
    let negative = editor.update_with(Budget::new().seconds(-1.0), Control::new()).unwrap_err();
    assert_eq!(negative.kind, ErrorKind::InvalidArgument);
}

#[test]
fn what_is_wrong_is_refused() {
    let mut editor = editor(4);
    let wrong = |result: Result<(), beltrami::Error>| result.unwrap_err().kind;
    assert_eq!(wrong(editor.open_seams(&[[0_u32, 24]])), ErrorKind::InvalidArgument);
    assert_eq!(wrong(editor.close_seams(&[[0_u64, 99]])), ErrorKind::IndexOutOfRange);
    assert_eq!(wrong(editor.select(&[99_u32])), ErrorKind::IndexOutOfRange);
    assert_eq!(wrong(editor.lock(&[77], true)), ErrorKind::InvalidArgument);
    let none: &[[f32; 2]] = &[];
    assert_eq!(wrong(editor.set_pins(&[0_u32], none)), ErrorKind::InvalidArgument);
    assert_eq!(wrong(editor.set_pins(&[0_u32], &[[f32::NAN, 0.0]])), ErrorKind::NonFinite);
    let (positions, faces) = sheet(2);
    let labels = vec![0_u32; faces.len()];
    let surface = Surface::new(&positions, &faces).face_labels(&labels);
    assert_eq!(Editor::new(&surface).map(drop).unwrap_err().kind, ErrorKind::InvalidArgument);
}

#[test]
fn an_empty_view_of_faces_selects_all() {
    let mut editor = editor(3);
    editor.select(View::<u32, 1>::from_flat(&[]).unwrap()).unwrap();
    assert_eq!(editor.update().unwrap(), Status::Injective);
}

#[test]
fn progress_and_tokens_end_updates_and_the_editor_goes_on() {
    let mut editor = editor(12);
    let before = editor.corner_uvs::<[f64; 2]>();
    let all = ids(&editor);
    editor.renew(&all, true).unwrap();
    let stop = Control::new().on_progress(|_| ControlFlow::Break(()));
    let ended = editor.update_with(Budget::new(), stop).unwrap_err();
    assert_eq!(ended.kind, ErrorKind::Cancelled);
    let panics = catch_unwind(AssertUnwindSafe(|| {
        let control = Control::new().on_progress(|_| panic!("enough"));
        editor.update_with(Budget::new(), control).map(drop)
    }));
    assert!(panics.is_err());
    let token = CancelToken::new();
    token.cancel();
    let control = Control::new().cancel_token(&token);
    assert_eq!(editor.update_with(Budget::new(), control).unwrap_err().kind, ErrorKind::Cancelled);
    assert_eq!(editor.corner_uvs::<[f64; 2]>(), before);
    assert_eq!(editor.update().unwrap(), Status::Injective);
}

#[test]
fn another_thread_cancels_and_editors_move_between_threads() {
    let mut editor = editor(20);
    let token = CancelToken::new();
    let (started, wait) = mpsc::channel();
    let all = ids(&editor);
    let other = thread::spawn({
        let token = token.clone();
        move || {
            editor.renew(&all, true).unwrap();
            let control = Control::new().cancel_token(&token).on_progress(|_| {
                let _ = started.send(());
                while !token.is_cancelled() {
                    thread::yield_now();
                }
                ControlFlow::Continue(())
            });
            let ended = editor.update_with(Budget::new(), control).unwrap_err().kind;
            (editor, ended)
        }
    });
    wait.recv().unwrap();
    token.cancel();
    let (mut editor, ended) = other.join().unwrap();
    assert_eq!(ended, ErrorKind::Cancelled);
    assert_eq!(editor.update().unwrap(), Status::Injective);
}
