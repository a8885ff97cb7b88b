//! Editing: one surface whose seams and pins move, and maps that follow.

use std::ffi::c_void;
use std::mem::size_of;
use std::panic::resume_unwind;
use std::ptr;

use beltrami_sys as sys;

use crate::atlas::{require_room, Get};
use crate::atlas_report::AtlasCertificate;
use crate::context::Context;
use crate::control::{Control, Trampoline};
use crate::editor_report::{Budget, Changes, ChartFlags, EditorChart, EditorSummary, Mark};
use crate::error::{Error, ErrorKind};
use crate::mesh::{Uv, Uvs, UvsMut};
use crate::options::UnwrapOptions;
use crate::parameterization::Status;
use crate::surface::{Edges, Integers, Surface};
use crate::verdict::count;
use crate::view::{Buffer, WideIndex};

/// A session of edits on one surface: seams and pins that move, and maps that follow.
///
/// Edits are noted at once. [`update`](Self::update) then maps the charts that they concern and no
/// others, from the maps that they have, and judges each exactly. A call that fails leaves the maps
/// as they were. The same calls give the same bits, but for updates that a limit of time ends.
///
/// It keeps a copy of the surface. It may move to another thread, and is used by one thread at a
/// time; any thread may end an update by the [`CancelToken`](crate::CancelToken) that it was given.
///
/// ```
/// use beltrami::{Budget, Control, Editor, Status, Surface};
///
/// let positions =
///     [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0],
///      [0.0, 1.0, 0.0], [1.0, 1.0, 1.0], [2.0, 1.0, 0.0]];
/// let faces = [[0_u32, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]];
///
/// let mut editor = Editor::new(&Surface::new(&positions, &faces))?;
/// assert_eq!(editor.update()?, Status::Injective);
/// let mark = editor.save()?;
/// editor.open_seams(&[[1_u32, 4]])?;
/// let status = editor.update_with(Budget::new().steps(2), Control::new())?;
/// let changes = editor.changes::<[f32; 2]>(); // the corners that moved, and where to
/// assert!(editor.check()?.injective);
/// editor.restore(mark)?;
/// # assert!(status == Status::Injective || status == Status::NotConverged);
/// # assert_eq!(changes.corners.len(), changes.uvs.len());
/// # assert_eq!(editor.summary().charts, 1);
/// # Ok::<(), beltrami::Error>(())
/// ```
///
/// It is not `Sync`, as a shared reference to it still writes to the context:
///
/// ```compile_fail,E0277
/// fn share(_: impl Sync) {}
/// fn an_editor(editor: beltrami::Editor) {
///     share(editor);
/// }
/// ```
#[derive(Debug)]
pub struct Editor {
    context: Context,
    options: UnwrapOptions,
    corners: usize,
    faces: usize,
    /// A token was cancelled when a call had just ended: its request may reach the next one.
    maybe_late_request: bool,
}

impl Editor {
    /// A session over a surface with default options. With [`seams`](Surface::seams) these are cut;
    /// with [`corner_uvs`](Surface::corner_uvs) charts keep them until an edit concerns them, and
    /// seams run where they differ. Without UVs the first update lays all charts side by side.
    ///
    /// # Errors
    ///
    /// Those of [`Unwrapper::unwrap`](crate::Unwrapper::unwrap) and of
    /// [`Unwrapper::new`](crate::Unwrapper::new); [`InvalidArgument`](ErrorKind::InvalidArgument) for
    /// pins, labels, paint and all else of a surface that an editor takes no notice of.
    pub fn new(surface: &Surface<'_>) -> Result<Editor, Error> {
        Editor::with_options(surface, &UnwrapOptions::new(), Control::new())
    }

    /// The same with options, watched and ended by `control`. Those of flattening count as they are
    /// here, those of packing and threads may be changed.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new), and [`Cancelled`](ErrorKind::Cancelled) by `control`.
    ///
    /// # Panics
    ///
    /// Where the progress closure does, with what it panics with.
    pub fn with_options(
        surface: &Surface<'_>,
        options: &UnwrapOptions,
        control: Control<'_>,
    ) -> Result<Editor, Error> {
        let context = Context::new()?;
        context.apply(options.values())?;
        let raw = surface.raw(&control.token)?;
        let mut editor = Editor {
            context,
            options: options.clone(),
            corners: surface.corner_count(),
            faces: surface.face_count(),
            maybe_late_request: false,
        };
        editor
            .run(control, |context, progress, user| {
                // SAFETY: the context is alive; the views behind the surface are borrowed, all their
                // items are there, and there are as many as `raw` made sure of; the token lives longer;
                // `user` is what `progress` expects.
                unsafe { sys::beltrami_session_begin(context, &raw, progress, user) }
            })
            .map(drop)?;
        Ok(editor)
    }

    /// Takes these options for later calls of [`pack`](Self::pack), and their threads; those that
    /// are not set in them are the defaults again. On failure the old ones stay.
    ///
    /// # Errors
    ///
    /// [`InvalidArgument`](ErrorKind::InvalidArgument) for a value that is out of range.
    pub fn set_options(&mut self, options: &UnwrapOptions) -> Result<(), Error> {
        self.context.replace(self.options.values(), options.values())?;
        self.options = options.clone();
        Ok(())
    }

    /// Runs loops on the caller's threads: see
    /// [`Unwrapper::run_loops_by`](crate::Unwrapper::run_loops_by).
    pub fn run_loops_by(
        &mut self,
        closure: impl Fn(usize, &(dyn Fn(usize) + Sync)) + Send + Sync + 'static,
    ) {
        self.context.run_loops_by(closure);
    }

    /// Opens seams at edges, by their vertices. What meets no border and no other seam opens nothing
    /// yet. Where seams leave something that is no disk, further edges are [cut](Self::opened).
    ///
    /// # Errors
    ///
    /// [`InvalidArgument`](ErrorKind::InvalidArgument) where a pair is no edge, or lies inside a
    /// polygon, and [`IndexOutOfRange`](ErrorKind::IndexOutOfRange); nothing is noted then.
    pub fn open_seams<'a>(&mut self, edges: impl Into<Edges<'a>>) -> Result<(), Error> {
        self.set_seams(edges.into(), 1)
    }

    /// Closes seams at edges.
    ///
    /// # Errors
    ///
    /// As [`open_seams`](Self::open_seams).
    pub fn close_seams<'a>(&mut self, edges: impl Into<Edges<'a>>) -> Result<(), Error> {
        self.set_seams(edges.into(), 0)
    }

    fn set_seams(&mut self, edges: Edges<'_>, open: i32) -> Result<(), Error> {
        self.edit(edges.0, |context, buffer, count| {
            // SAFETY: the context is alive, and `count` items of two are borrowed.
            unsafe { sys::beltrami_session_set_seams(context, buffer, count, open) }
        })
    }

    /// Sets pins in place of all before: corners, counted from 0 face after face, and where they are
    /// to be. None takes all off.
    ///
    /// # Errors
    ///
    /// [`InvalidArgument`](ErrorKind::InvalidArgument) where there are not as many UVs as corners,
    /// [`IndexOutOfRange`](ErrorKind::IndexOutOfRange), [`NonFinite`](ErrorKind::NonFinite), with
    /// the corner.
    pub fn set_pins<'a>(
        &mut self,
        corners: impl Into<Integers<'a>>,
        uvs: impl Into<Uvs<'a>>,
    ) -> Result<(), Error> {
        let (corners, uvs) = (corners.into(), uvs.into());
        if corners.len() != uvs.len() {
            return Err(Error::argument(format!(
                "there are {} UVs for {} pins: give one per pin",
                uvs.len(),
                corners.len()
            )));
        }
        let places = uvs.0.raw();
        self.edit(corners.0, |context, buffer, count| {
            // SAFETY: the context is alive, and `count` corners and places are borrowed.
            unsafe { sys::beltrami_session_set_pins(context, buffer, &places, count) }
        })
    }

    /// What is held of each pin that is set, a [`PinKind`](crate::PinKind) as an integer, and a
    /// direction for each, which says something of [`PinKind::Line`](crate::PinKind::Line) alone. All
    /// are points at first.
    ///
    /// # Errors
    ///
    /// [`InvalidArgument`](ErrorKind::InvalidArgument) where there are not as many as pins, or a kind
    /// or direction is none, with the corner.
    pub fn set_pin_kinds<'a>(
        &mut self,
        kinds: impl Into<Integers<'a>>,
        directions: impl Into<Uvs<'a>>,
    ) -> Result<(), Error> {
        let (kinds, directions) = (kinds.into(), directions.into());
        if kinds.len() != directions.len() {
            return Err(Error::argument("there is not one direction for each kind of a pin"));
        }
        let along = directions.0.raw();
        self.edit(kinds.0, |context, buffer, count| {
            // SAFETY: the context is alive, and `count` kinds and directions are borrowed.
            unsafe { sys::beltrami_session_set_pin_kinds(context, buffer, &along, count) }
        })
    }

    /// Lets these faces move alone, by their numbers, which makes their charts due; the vertices of
    /// all others stay where they are. None lets all move.
    ///
    /// # Errors
    ///
    /// [`IndexOutOfRange`](ErrorKind::IndexOutOfRange).
    pub fn select<'a>(&mut self, faces: impl Into<Integers<'a>>) -> Result<(), Error> {
        self.edit(faces.into().0, |context, buffer, count| {
            // SAFETY: the context is alive, and `count` numbers are borrowed.
            unsafe { sys::beltrami_session_select(context, buffer, count) }
        })
    }

    /// Locks charts, by [their numbers](EditorChart::id), which then stay whatever happens, or
    /// unlocks them.
    ///
    /// # Errors
    ///
    /// [`InvalidArgument`](ErrorKind::InvalidArgument) where there is no chart of a number.
    pub fn lock(&mut self, charts: &[u64], locked: bool) -> Result<(), Error> {
        self.edit(Integers::from(charts).0, |context, buffer, count| {
            // SAFETY: the context is alive, and `count` numbers are borrowed.
            unsafe { sys::beltrami_session_lock(context, buffer, count, locked.into()) }
        })
    }

    /// Gives charts these flags in place of those that they have. One to be aligned is due; pins
    /// overrule it.
    ///
    /// # Errors
    ///
    /// As [`lock`](Self::lock).
    pub fn set_flags(&mut self, charts: &[u64], flags: ChartFlags) -> Result<(), Error> {
        self.edit(Integers::from(charts).0, |context, buffer, count| {
            // SAFETY: the context is alive, and `count` numbers are borrowed.
            unsafe { sys::beltrami_session_set_flags(context, buffer, count, flags.raw()) }
        })
    }

    /// Has the next update map charts anew; `cold`: from nothing, in place of the map that is there.
    ///
    /// # Errors
    ///
    /// As [`lock`](Self::lock).
    pub fn renew(&mut self, charts: &[u64], cold: bool) -> Result<(), Error> {
        self.edit(Integers::from(charts).0, |context, buffer, count| {
            // SAFETY: the context is alive, and `count` numbers are borrowed.
            unsafe { sys::beltrami_session_renew(context, buffer, count, cold.into()) }
        })
    }

    /// Cuts and maps what the edits concern.
    ///
    /// # Errors
    ///
    /// [`Pins`](ErrorKind::Pins) with the first corner that cannot be met together with those before
    /// it; [`InvalidState`](ErrorKind::InvalidState) with a face, where parts that may not move
    /// cannot be joined; [`OutOfMemory`](ErrorKind::OutOfMemory), [`Solver`](ErrorKind::Solver),
    /// [`Internal`](ErrorKind::Internal). A chart that is not injective is no error.
    pub fn update(&mut self) -> Result<Status, Error> {
        self.update_with(Budget::new(), Control::new())
    }

    /// The same within a budget, watched and ended by `control`.
    /// [`NotConverged`](Status::NotConverged) says that the next update goes on.
    ///
    /// # Errors
    ///
    /// As [`update`](Self::update), [`Cancelled`](ErrorKind::Cancelled) by `control`, and
    /// [`InvalidArgument`](ErrorKind::InvalidArgument) for seconds below 0.
    ///
    /// # Panics
    ///
    /// Where the progress closure does, with what it panics with; the editor can be used again.
    pub fn update_with(&mut self, budget: Budget, control: Control<'_>) -> Result<Status, Error> {
        let steps = i32::try_from(budget.steps).unwrap_or(i32::MAX);
        self.run(control, |context, progress, user| {
            // SAFETY: the context is alive, and `user` is what `progress` expects.
            unsafe { sys::beltrami_session_update(context, budget.seconds, steps, progress, user) }
        })
    }

    /// Packs all charts onto pages; locked ones and those with pins stay. Page p is the unit square
    /// at (p % 10, p / 10).
    ///
    /// # Errors
    ///
    /// [`NoRoom`](ErrorKind::NoRoom); [`InvalidState`](ErrorKind::InvalidState) before the first
    /// update; [`InvalidArgument`](ErrorKind::InvalidArgument) where a chart that stays lies on no
    /// page, with a face; [`OutOfMemory`](ErrorKind::OutOfMemory).
    pub fn pack(&mut self) -> Result<Status, Error> {
        self.pack_with(None, Control::new())
    }

    /// The same of charts by their numbers, watched and ended by `control`: they keep their sizes,
    /// and their places where there is no room elsewhere. `None`: all.
    ///
    /// # Errors
    ///
    /// As [`pack`](Self::pack), [`InvalidArgument`](ErrorKind::InvalidArgument) for no charts, and
    /// [`Cancelled`](ErrorKind::Cancelled) by `control`.
    ///
    /// # Panics
    ///
    /// As [`update_with`](Self::update_with).
    pub fn pack_with(
        &mut self,
        charts: Option<&[u64]>,
        control: Control<'_>,
    ) -> Result<Status, Error> {
        if charts.is_some_and(<[u64]>::is_empty) {
            return Err(Error::argument("there are no charts to pack: give None for all"));
        }
        let charts = Integers::from(charts.unwrap_or_default()).0;
        self.run(control, |context, progress, user| {
            // SAFETY: the context is alive, the numbers are borrowed, and `user` is what `progress`
            // expects.
            unsafe {
                let (buffer, count) = (charts.raw(), charts.len as u64);
                sys::beltrami_session_pack(context, &buffer, count, progress, user)
            }
        })
    }

    /// The exact verdict on all charts together, in double precision.
    ///
    /// # Errors
    ///
    /// [`OutOfMemory`](ErrorKind::OutOfMemory).
    pub fn check(&self) -> Result<AtlasCertificate, Error> {
        let mut raw = AtlasCertificate::raw();
        // SAFETY: the context is alive, and `raw` has the size that it says.
        let status = unsafe { sys::beltrami_session_check(self.context.raw(), &mut raw) };
        self.context.check(status)?;
        Ok(AtlasCertificate::new(&raw))
    }

    /// Notes seams, pins, locks, selection and maps.
    ///
    /// # Errors
    ///
    /// [`OutOfMemory`](ErrorKind::OutOfMemory).
    pub fn save(&mut self) -> Result<Mark, Error> {
        let mut mark = 0;
        // SAFETY: the context is alive, and `mark` is valid for a write.
        let status = unsafe { sys::beltrami_session_save(self.context.raw(), &mut mark) };
        self.context.check(status)?;
        Ok(Mark(mark))
    }

    /// Goes back to what was noted, which stays noted: the same bits, and what follows as well.
    ///
    /// # Errors
    ///
    /// [`InvalidArgument`](ErrorKind::InvalidArgument) where it was forgotten;
    /// [`OutOfMemory`](ErrorKind::OutOfMemory).
    pub fn restore(&mut self, mark: Mark) -> Result<(), Error> {
        // SAFETY: the context is alive.
        self.context.check(unsafe { sys::beltrami_session_restore(self.context.raw(), mark.0) })
    }

    /// Drops what was noted.
    ///
    /// # Errors
    ///
    /// [`InvalidArgument`](ErrorKind::InvalidArgument) where it was forgotten.
    pub fn forget(&mut self, mark: Mark) -> Result<(), Error> {
        // SAFETY: the context is alive.
        self.context.check(unsafe { sys::beltrami_session_forget(self.context.raw(), mark.0) })
    }

    /// How it stands.
    pub fn summary(&self) -> EditorSummary {
        EditorSummary::new(&self.raw())
    }

    /// The charts, in the order of their least faces.
    pub fn charts(&self) -> Vec<EditorChart> {
        (0..self.raw().charts).map(|index| self.chart(index)).collect()
    }

    fn chart(&self, index: u64) -> EditorChart {
        let mut raw = sys::beltrami_session_chart {
            struct_size: size_of::<sys::beltrami_session_chart>() as u32,
            ..Default::default()
        };
        // SAFETY: `raw` has the size that it says.
        self.read(|context| unsafe { sys::beltrami_get_session_chart(context, index, &mut raw) });
        EditorChart::new(&raw)
    }

    /// The corners that the last update, pack or restore moved.
    pub fn changes<T: Uv>(&self) -> Changes<T> {
        let len = count(self.raw().changes);
        let (mut corners, mut uvs) = (vec![0_u64; len], vec![T::origin(); len]);
        let room = T::room(&mut uvs);
        let (places, scalar) = (room.0.first, room.0.scalar);
        let numbers = corners.as_mut_ptr().cast::<c_void>();
        // SAFETY: there is room for as many corners, and UVs of this type next to each other.
        self.read(|context| unsafe {
            sys::beltrami_get_session_changes(context, numbers, sys::BELTRAMI_U64, places, scalar)
        });
        Changes { corners: corners.into_iter().map(count).collect(), uvs }
    }

    /// One (u, v) for every corner, face after face. Single precision is rounded to nearest; with
    /// the option `float32` no number changes.
    pub fn corner_uvs<T: Uv>(&self) -> Vec<T> {
        let mut uvs = vec![T::origin(); self.corners];
        self.fill(T::room(&mut uvs), sys::beltrami_get_session_uvs);
        uvs
    }

    /// Writes what [`corner_uvs`](Self::corner_uvs) returns into memory of the caller's.
    ///
    /// # Errors
    ///
    /// [`InvalidArgument`](ErrorKind::InvalidArgument) where there is not room for one UV per
    /// corner, neither more nor less; nothing is written then.
    pub fn write_corner_uvs<'b>(&self, room: impl Into<UvsMut<'b>>) -> Result<(), Error> {
        let room = require_room(room.into(), self.corners, "corner")?;
        self.fill(room, sys::beltrami_get_session_uvs);
        Ok(())
    }

    /// The [number](EditorChart::id) of the chart of every face; `None` for one without area.
    pub fn face_charts(&self) -> Vec<Option<u64>> {
        let mut charts = vec![0_u64; self.faces];
        let out = charts.as_mut_ptr().cast();
        // SAFETY: there is room for a number per face.
        self.read(|context| unsafe {
            sys::beltrami_get_session_face_charts(context, out, sys::BELTRAMI_U64, 0)
        });
        charts.into_iter().map(|id| (id != sys::BELTRAMI_NO_ELEMENT).then_some(id)).collect()
    }

    /// Edges that had to be cut beside the seams, by their vertices, in `u32` or `u64`. They stay so
    /// until they are opened or closed.
    pub fn opened<T: WideIndex>(&self) -> Vec<[T; 2]> {
        let mut edges = vec![[T::default(); 2]; count(self.raw().opened)];
        let out = edges.as_mut_ptr().cast();
        // SAFETY: there is room for two numbers of this type per edge.
        self.read(|context| unsafe { sys::beltrami_get_session_opened(context, out, T::TYPE, 0) });
        edges
    }

    fn raw(&self) -> sys::beltrami_session {
        let mut raw = sys::beltrami_session {
            struct_size: size_of::<sys::beltrami_session>() as u32,
            ..Default::default()
        };
        // SAFETY: `raw` has the size that it says.
        self.read(|context| unsafe { sys::beltrami_get_session(context, &mut raw) });
        raw
    }

    /// Writes UVs; there is room for as many as `get` writes.
    fn fill(&self, room: UvsMut<'_>, get: Get) {
        let (out, scalar, stride) = (room.0.first, room.0.scalar, room.0.stride as u64);
        // SAFETY: there is room for a UV of this type at every stride.
        self.read(|context| unsafe { get(context, out, scalar, stride) });
    }

    /// Reads from the context, which cannot fail where there is a session and the arguments are in
    /// order.
    fn read(&self, call: impl FnOnce(*mut sys::beltrami_context) -> sys::beltrami_status) {
        let read = self.context.check(call(self.context.raw()));
        read.expect("the library hands out how a session stands");
    }

    /// A call that notes an edit, given by some items.
    fn edit(
        &mut self,
        items: Buffer<'_>,
        call: impl FnOnce(
            *mut sys::beltrami_context,
            *const sys::beltrami_buffer,
            u64,
        ) -> sys::beltrami_status,
    ) -> Result<(), Error> {
        let buffer = items.raw();
        self.context.check(call(self.context.raw(), &buffer, items.len as u64))
    }

    /// A call that takes its time. A request of a token that came when the call before it had just
    /// ended ends it, too, which the library cannot tell apart: then it is made again.
    fn run(
        &mut self,
        control: Control<'_>,
        call: impl Fn(
            *mut sys::beltrami_context,
            sys::beltrami_progress,
            *mut c_void,
        ) -> sys::beltrami_status,
    ) -> Result<Status, Error> {
        let mut trampoline = Trampoline::new(control.progress);
        // SAFETY: the guard goes before this function ends, the context later.
        let Some(watch) = (unsafe { control.token.watch(self.context.handle()) }) else {
            return Err(Error::new(ErrorKind::Cancelled, "the run was cancelled before it began"));
        };
        let run = |trampoline: &mut Trampoline<'_>| {
            let entry = trampoline.entry();
            call(self.context.raw(), entry, ptr::from_mut(trampoline).cast())
        };
        let mut status = run(&mut trampoline);
        let late_request = self.maybe_late_request
            && status == sys::BELTRAMI_E_CANCELLED
            && !trampoline.broke
            && !self.context.host_has_panicked()
            && !control.token.is_cancelled();
        if late_request {
            status = run(&mut trampoline); // the request is used up
        }
        drop(watch);
        self.maybe_late_request = control.token.is_cancelled();
        if let Some(payload) = trampoline.panic.take() {
            drop(trampoline); // not while a panic is on its way, or another one would abort
            resume_unwind(payload);
        }
        self.context.check(status)?;
        Ok(Status::from_raw(status))
    }
}
