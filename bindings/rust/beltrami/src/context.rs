//! The library's context: it goes with its owner, and tells why a call failed.

use std::ffi::CStr;
use std::panic::resume_unwind;
use std::ptr::{self, NonNull};

use beltrami_sys as sys;

use crate::error::{Element, Error};
use crate::host_loop::{self, HostLoop};
use crate::options::Value;

/// A live context, which one thread uses at a time: it is Send, and not Sync.
#[derive(Debug)]
pub(crate) struct Context {
    raw: NonNull<sys::beltrami_context>,
    host: Option<Box<HostLoop>>,
}

// SAFETY: a context belongs to one thread at a time, whichever, and has no thread-local state.
unsafe impl Send for Context {}

impl Drop for Context {
    fn drop(&mut self) {
        // SAFETY: the context is alive, and no run is under way: that borrows its owner.
        unsafe { sys::beltrami_destroy(self.raw()) };
    }
}

impl Context {
    /// Fails with `AbiMismatch` or `OutOfMemory`.
    pub(crate) fn new() -> Result<Context, Error> {
        let mut context = ptr::null_mut();
        // SAFETY: `context` is valid for a write.
        let status = unsafe { sys::beltrami_create(&mut context) };
        NonNull::new(context)
            .map(|raw| Context { raw, host: None })
            .ok_or_else(|| Error::from_status(status, None))
    }

    pub(crate) fn handle(&self) -> NonNull<sys::beltrami_context> {
        self.raw
    }

    pub(crate) fn raw(&self) -> *mut sys::beltrami_context {
        self.raw.as_ptr()
    }

    /// Has loops run by `closure`.
    pub(crate) fn run_loops_by(
        &mut self,
        closure: impl Fn(usize, &(dyn Fn(usize) + Sync)) + Send + Sync + 'static,
    ) {
        let host = Box::new(HostLoop::new(closure, self.raw));
        let user = ptr::from_ref::<HostLoop>(&host).cast_mut().cast();
        // SAFETY: the context is alive, and the loop lives as long: it is dropped after the context,
        // or after another one has taken its place here.
        let status =
            unsafe { sys::beltrami_set_parallel_for(self.raw(), Some(host_loop::call), user) };
        debug_assert_eq!(status, sys::BELTRAMI_OK);
        self.host = Some(host);
    }

    pub(crate) fn host_has_panicked(&self) -> bool {
        self.host.as_ref().is_some_and(|host| host.has_panicked())
    }

    /// Sets options by key. Fails with `InvalidArgument` at the first that is out of range.
    pub(crate) fn apply(&self, values: impl Iterator<Item = (i32, Value)>) -> Result<(), Error> {
        for (key, value) in values {
            // SAFETY: the context is alive.
            self.check(unsafe {
                match value {
                    Value::Int(value) => sys::beltrami_set_int(self.raw(), key, value),
                    Value::Float(value) => sys::beltrami_set_float(self.raw(), key, value),
                }
            })?;
        }
        Ok(())
    }

    /// Sets `new` options in place of `old` ones, which stay where one of the new is refused.
    pub(crate) fn replace(
        &self,
        old: impl Iterator<Item = (i32, Value)>,
        new: impl Iterator<Item = (i32, Value)>,
    ) -> Result<(), Error> {
        let result = self.apply(new);
        if result.is_err() {
            self.apply(old)?; // they were taken before, so they are again
        }
        result
    }

    /// Turns a negative status of the last call into its failure. Goes on with the panic of a loop.
    pub(crate) fn check(&self, status: sys::beltrami_status) -> Result<(), Error> {
        if let Some(payload) = self.host.as_ref().and_then(|host| host.take_panic()) {
            resume_unwind(payload);
        }
        if status >= 0 {
            return Ok(());
        }
        // SAFETY: the context is alive, and `self` is not Sync: this thread alone has it. The
        // message is copied before the next call.
        let (message, kind, index) = unsafe {
            (
                CStr::from_ptr(sys::beltrami_error_message(self.raw())).to_string_lossy(),
                sys::beltrami_error_element_kind(self.raw()),
                sys::beltrami_error_element(self.raw()),
            )
        };
        let mut error = Error::from_status(status, Element::new(kind, index));
        if !message.is_empty() {
            error.message = message.into();
        }
        Err(error)
    }
}
