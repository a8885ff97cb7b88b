//! What a run tells its caller on the way, and how it is ended from outside.

use std::any::Any;
use std::ffi::{c_char, c_void};
use std::fmt;
use std::ops::ControlFlow;
use std::panic::{catch_unwind, AssertUnwindSafe};
use std::ptr::NonNull;
use std::sync::atomic::{AtomicI32, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use beltrami_sys as sys;

use crate::error::static_text;

/// How far a run has come.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Progress {
    /// The part of the work that is done: in [0, 1], never decreasing.
    pub fraction: f64,
    /// The stage under way: `"simplify"`, `"coarse"`, `"prolong"`, `"flatten"`, `"repair"`, ...
    pub stage: &'static str,
}

/// How to watch and to end a run: by a closure that hears of its progress, by a [`CancelToken`], by
/// both, or by neither (the default).
///
/// ```
/// # use beltrami::{CancelToken, Control, Flattener, Mesh};
/// use std::ops::ControlFlow;
///
/// # let positions = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 1.0], [0.0, 1.0, 0.0]];
/// # let faces = [[0_u32, 1, 2], [0, 2, 3]];
/// # let mesh = Mesh::new(&positions, &faces);
/// let token = CancelToken::new();
/// let control = Control::new().cancel_token(&token).on_progress(|progress| {
///     eprintln!("{:3.0} % {}", 100.0 * progress.fraction, progress.stage);
///     ControlFlow::Continue(())
/// });
/// let map = Flattener::new()?.flatten_with(&mesh, control)?.uvs::<[f32; 2]>();
/// # Ok::<(), beltrami::Error>(())
/// ```
#[derive(Default)]
#[must_use = "pass it to a run"]
pub struct Control<'a> {
    pub(crate) progress: Option<Box<ProgressFn<'a>>>,
    pub(crate) token: CancelToken,
}

type ProgressFn<'a> = dyn FnMut(Progress) -> ControlFlow<()> + 'a;

impl<'a> Control<'a> {
    /// Neither a closure nor a token.
    pub fn new() -> Control<'a> {
        Control::default()
    }

    /// Calls `closure` on the thread of the run, some ten times in most stages. A `Break` ends the
    /// run with [`Cancelled`](crate::ErrorKind::Cancelled); a panic ends it, too, and goes on in
    /// the caller.
    pub fn on_progress(mut self, closure: impl FnMut(Progress) -> ControlFlow<()> + 'a) -> Self {
        self.progress = Some(Box::new(closure));
        self
    }

    /// Lets `token` end the run with [`Cancelled`](crate::ErrorKind::Cancelled).
    pub fn cancel_token(mut self, token: &CancelToken) -> Self {
        self.token = token.clone();
        self
    }
}

impl fmt::Debug for Control<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("Control")
            .field("progress", &self.progress.is_some())
            .field("token", &self.token)
            .finish()
    }
}

/// Ends runs, and checks such as [`check_injective_with`](crate::check_injective_with), from any
/// thread.
///
/// A token is cancelled once and stays so: it ends the runs that have it now, and every later run
/// that gets it before it has begun. So no request is lost, and none reaches a run that it was not
/// meant for; take a new token for new work. Clones are one token, and one token may be given to
/// runs of several flatteners. It keeps no [`Flattener`](crate::Flattener) alive.
///
/// A run ends soon: within milliseconds in most stages, at the latest after one ordering or
/// factorization.
///
/// Not for signal handlers, since it takes a lock.
#[derive(Clone, Default)]
pub struct CancelToken {
    shared: Arc<Shared>,
}

#[derive(Default)]
struct Shared {
    /// 1 once it is cancelled; what checks look at.
    number: AtomicI32,
    /// The contexts whose runs are under way with this token.
    runs: Mutex<Vec<RunningContext>>,
}

/// A context whose run is under way, so that it is alive.
#[derive(PartialEq)]
struct RunningContext(NonNull<sys::beltrami_context>);

// SAFETY: it is used for beltrami_cancel alone, which any thread may call.
unsafe impl Send for RunningContext {}

impl CancelToken {
    /// A token that is not cancelled.
    pub fn new() -> CancelToken {
        CancelToken::default()
    }

    /// Asks every run that has this token, now or later, to end. Returns at once.
    pub fn cancel(&self) {
        let runs = self.lock();
        self.shared.number.store(1, Ordering::SeqCst);
        for run in runs.iter() {
            // SAFETY: a run takes its context from the list before the context can go away, and
            // waits for this lock to do so.
            unsafe { sys::beltrami_cancel(run.0.as_ptr()) };
        }
    }

    /// Whether [`cancel`](Self::cancel) was called.
    pub fn is_cancelled(&self) -> bool {
        self.shared.number.load(Ordering::SeqCst) != 0
    }

    /// Where the library looks for a request, as long as the token lives: `beltrami_mesh.cancel`.
    pub(crate) fn number(&self) -> *const i32 {
        self.shared.number.as_ptr()
    }

    /// Makes the token one that ends the run on `context`, until the guard goes; `None` where the
    /// token is cancelled already.
    ///
    /// # Safety
    ///
    /// The context lives longer than the guard.
    pub(crate) unsafe fn watch(
        &self,
        context: NonNull<sys::beltrami_context>,
    ) -> Option<Watch<'_>> {
        let mut runs = self.lock();
        if self.is_cancelled() {
            return None;
        }
        runs.push(RunningContext(context));
        Some(Watch { token: self, context })
    }

    fn lock(&self) -> MutexGuard<'_, Vec<RunningContext>> {
        // Nothing that holds the lock can panic half-way.
        self.shared.runs.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl fmt::Debug for CancelToken {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("CancelToken").field("cancelled", &self.is_cancelled()).finish()
    }
}

/// As long as it lives, its token ends the run on its context.
pub(crate) struct Watch<'a> {
    token: &'a CancelToken,
    context: NonNull<sys::beltrami_context>,
}

impl Drop for Watch<'_> {
    fn drop(&mut self) {
        let mut runs = self.token.lock();
        let run = RunningContext(self.context);
        if let Some(place) = runs.iter().position(|other| *other == run) {
            runs.swap_remove(place);
        }
    }
}

/// The progress closure on its way through C: what the library gets as `user`.
pub(crate) struct Trampoline<'a> {
    closure: Option<Box<ProgressFn<'a>>>,
    /// Whether the closure ended the run.
    pub(crate) broke: bool,
    /// What the closure panicked with: no panic may pass the frames of C++.
    pub(crate) panic: Option<Box<dyn Any + Send>>,
}

impl<'a> Trampoline<'a> {
    pub(crate) fn new(closure: Option<Box<ProgressFn<'a>>>) -> Self {
        Trampoline { closure, broke: false, panic: None }
    }

    /// What to pass to the library beside `user`, a pointer to this.
    pub(crate) fn entry(&self) -> sys::beltrami_progress {
        self.closure.as_ref().map(|_| call as _)
    }

    fn report(&mut self, progress: Progress) -> ControlFlow<()> {
        let Some(closure) = &mut self.closure else { return ControlFlow::Continue(()) };
        if self.panic.is_some() {
            return ControlFlow::Break(());
        }
        // The closure is not called again after a panic, so nobody sees what it left half-done but
        // the caller, in whom the panic goes on. It is dropped there, too: that may panic as well.
        let flow = catch_unwind(AssertUnwindSafe(|| closure(progress))).unwrap_or_else(|payload| {
            self.panic = Some(payload);
            ControlFlow::Break(())
        });
        self.broke |= flow.is_break();
        flow
    }
}

/// What the library calls.
///
/// # Safety
///
/// `user` points to a `Trampoline` that nobody else uses during the run.
unsafe extern "C" fn call(user: *mut c_void, fraction: f64, stage: *const c_char) -> i32 {
    // SAFETY: the caller's promise; the names of stages are static texts.
    let (trampoline, stage) = unsafe { (&mut *user.cast::<Trampoline<'_>>(), static_text(stage)) };
    i32::from(trampoline.report(Progress { fraction, stage }).is_break())
}
