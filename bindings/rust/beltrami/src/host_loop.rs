//! The loops of a run on the threads of the caller, such as those of rayon.

use std::any::Any;
use std::ffi::c_void;
use std::fmt;
use std::panic::{catch_unwind, AssertUnwindSafe};
use std::ptr::NonNull;
use std::sync::{Mutex, PoisonError};

use beltrami_sys as sys;

/// Calls its second argument once with each index below its first, on any threads.
type Loop = dyn Fn(usize, &(dyn Fn(usize) + Sync)) + Send + Sync;

/// A caller's loop, on its way through C: what the library gets as `user`.
pub(crate) struct HostLoop {
    closure: Box<Loop>,
    context: NonNull<sys::beltrami_context>,
    /// What the closure panicked with: no panic may pass the frames of C++.
    panic: Mutex<Option<Box<dyn Any + Send>>>,
}

// SAFETY: the context is used for beltrami_cancel alone, which any thread may call.
unsafe impl Send for HostLoop {}

impl fmt::Debug for HostLoop {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("HostLoop")
    }
}

/// The data of a job, which is for any thread to hand on.
#[derive(Clone, Copy)]
struct JobData(*mut c_void);

// SAFETY: the library says so of what it passes to a loop, for the time of the loop.
unsafe impl Sync for JobData {}

impl JobData {
    fn get(&self) -> *mut c_void {
        self.0
    }
}

impl HostLoop {
    pub(crate) fn new(
        closure: impl Fn(usize, &(dyn Fn(usize) + Sync)) + Send + Sync + 'static,
        context: NonNull<sys::beltrami_context>,
    ) -> HostLoop {
        HostLoop { closure: Box::new(closure), context, panic: Mutex::new(None) }
    }

    /// What the closure has panicked with since this was asked last.
    pub(crate) fn take_panic(&self) -> Option<Box<dyn Any + Send>> {
        self.panic.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    pub(crate) fn has_panicked(&self) -> bool {
        self.panic.lock().unwrap_or_else(PoisonError::into_inner).is_some()
    }

    fn run(&self, count: usize, job: &(dyn Fn(usize) + Sync)) {
        if self.has_panicked() {
            return; // the library does what is left undone, up to where it hears of the cancel
        }
        // The closure is not called again in this run, so nobody sees what it left half-done but
        // the caller, in whom the panic goes on.
        let Err(payload) = catch_unwind(AssertUnwindSafe(|| (self.closure)(count, job))) else {
            return;
        };
        *self.panic.lock().unwrap_or_else(PoisonError::into_inner) = Some(payload);
        // SAFETY: the context is alive: its owner has this loop.
        unsafe { sys::beltrami_cancel(self.context.as_ptr()) };
    }
}

/// What the library calls.
///
/// # Safety
///
/// `user` points to a `HostLoop`; `job` and `data` are those of a loop under way.
pub(crate) unsafe extern "C" fn call(
    user: *mut c_void,
    count: i32,
    job: sys::beltrami_job,
    data: *mut c_void,
) {
    // SAFETY: the caller's promise.
    let host = unsafe { &*user.cast::<HostLoop>() };
    let Some(job) = job else { return };
    let data = JobData(data);
    host.run(usize::try_from(count).unwrap_or(0), &|index| {
        let index = i32::try_from(index).unwrap_or(0);
        // SAFETY: the reference to this closure goes before the loop ends, and the library takes
        // any index, on any thread, at any time until then.
        unsafe { job(data.get(), index) };
    });
}
