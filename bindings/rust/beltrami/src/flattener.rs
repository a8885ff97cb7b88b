//! Flattens: options, one mesh, the results of its last run.

use std::mem::size_of;
use std::panic::resume_unwind;
use std::ptr;

use beltrami_sys as sys;

use crate::context::Context;
use crate::control::{Control, Trampoline};
use crate::error::{Error, ErrorKind};
use crate::mesh::Mesh;
use crate::options::Options;
use crate::parameterization::Parameterization;

/// Flattens meshes, one after the other, with the same options.
///
/// It may move to another thread, and is used by one thread at a time. Flatteners share nothing:
/// for several meshes at a time take one for each thread. It keeps a copy of its last mesh and the
/// results of its last run, until it gets another mesh or goes.
///
/// ```
/// use beltrami::{Flattener, Mesh, Options};
///
/// let positions = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 1.0], [0.0, 1.0, 0.0]];
/// let faces = [[0_u32, 1, 2], [0, 2, 3]];
///
/// let mut flattener = Flattener::with_options(&Options::new().unit_square(true))?;
/// let map = flattener.flatten(&Mesh::new(&positions, &faces))?.ensure_float32_injective()?;
/// let uvs: Vec<[f32; 2]> = map.uvs();
/// # assert_eq!(uvs.len(), 4);
/// # Ok::<(), beltrami::Error>(())
/// ```
///
/// It is not `Sync`, as a shared reference to it still writes to the context:
///
/// ```compile_fail,E0277
/// fn share(_: impl Sync) {}
/// share(beltrami::Flattener::new());
/// ```
///
/// A result borrows the flattener, which cannot run again while it is in use:
///
/// ```compile_fail,E0499
/// # use beltrami::{Flattener, Mesh};
/// # fn twice(flattener: &mut Flattener, mesh: &Mesh<'_>) -> Result<(), beltrami::Error> {
/// let first = flattener.flatten(mesh)?;
/// let second = flattener.flatten(mesh)?;
/// first.uvs::<[f32; 2]>();
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Flattener {
    context: Context,
    options: Options,
    /// A token may have asked the context to cancel when its run was just over; such a request
    /// would end the next run.
    maybe_late_request: bool,
}

impl Flattener {
    /// A flattener with default options.
    ///
    /// # Errors
    ///
    /// [`AbiMismatch`](ErrorKind::AbiMismatch) where the library at run time is another than this
    /// crate was built for; [`OutOfMemory`](ErrorKind::OutOfMemory).
    pub fn new() -> Result<Flattener, Error> {
        let context = Context::new()?;
        Ok(Flattener { context, options: Options::new(), maybe_late_request: false })
    }

    /// A flattener with these options.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new) and [`set_options`](Self::set_options).
    pub fn with_options(options: &Options) -> Result<Flattener, Error> {
        let mut flattener = Flattener::new()?;
        flattener.set_options(options)?;
        Ok(flattener)
    }

    /// Takes these options for later runs; those that are not set in them are the defaults again.
    /// On failure the old ones stay.
    ///
    /// # Errors
    ///
    /// [`InvalidArgument`](ErrorKind::InvalidArgument) for a value that is out of range.
    pub fn set_options(&mut self, options: &Options) -> Result<(), Error> {
        self.context.replace(self.options.values(), options.values())?;
        self.options = options.clone();
        Ok(())
    }

    /// Runs loops on the caller's threads in place of the library's own: `closure` is given a count,
    /// at most that of the option `threads`, and a job to call once with each index below it, on any
    /// threads, before it returns. The result has the same bits. With rayon:
    ///
    /// ```
    /// # use beltrami::{Flattener, Options};
    /// use rayon::prelude::*;
    ///
    /// let mut flattener = Flattener::with_options(&Options::new().threads(4))?;
    /// flattener.run_loops_by(|count, job| (0..count).into_par_iter().for_each(job));
    /// # Ok::<(), beltrami::Error>(())
    /// ```
    ///
    /// A panic in `closure` ends the call that it runs for, and goes on in the caller.
    pub fn run_loops_by(
        &mut self,
        closure: impl Fn(usize, &(dyn Fn(usize) + Sync)) + Send + Sync + 'static,
    ) {
        self.context.run_loops_by(closure);
    }

    /// Copies and validates a mesh for [`run`](Self::run). A valid one drops the results of the old
    /// one; an invalid one leaves the flattener with its old mesh and results.
    ///
    /// # Errors
    ///
    /// The kinds from [`Empty`](ErrorKind::Empty) to [`ZeroArea`](ErrorKind::ZeroArea), with the
    /// element that is the cause; [`OutOfMemory`](ErrorKind::OutOfMemory).
    pub fn set_mesh(&mut self, mesh: &Mesh<'_>) -> Result<(), Error> {
        let raw = mesh.raw();
        // SAFETY: the context is alive; the views behind the mesh are borrowed as long as it, and
        // all their items are there.
        self.context.check(unsafe { sys::beltrami_set_mesh(self.context.raw(), &raw) })?;
        self.maybe_late_request = false; // setting a mesh drops it
        Ok(())
    }

    /// Bytes that the library will hold at the peak of the next [`run`](Self::run), with the mesh
    /// and the options that are set. Its copy of the mesh and the last results count, arrays of the
    /// caller do not. It is the least [`Options::memory_limit`] that the run can do with: below, it
    /// fails before it starts. Without a limit the default mode may take several times as much on
    /// hard meshes. With one it does without what takes that, or fails where there is no map then.
    ///
    /// # Errors
    ///
    /// [`InvalidState`](ErrorKind::InvalidState) without a mesh.
    pub fn estimate_memory(&self) -> Result<u64, Error> {
        let mut bytes = 0;
        // SAFETY: the context is alive, and `bytes` is valid for a write.
        let status = unsafe { sys::beltrami_estimate_memory(self.context.raw(), &mut bytes) };
        self.context.check(status)?;
        Ok(bytes)
    }

    /// Flattens the mesh that was set. On failure the results of the last run stay.
    ///
    /// # Errors
    ///
    /// [`InvalidState`](ErrorKind::InvalidState) without a mesh, [`Cancelled`](ErrorKind::Cancelled)
    /// by `control`, [`OutOfMemory`](ErrorKind::OutOfMemory), [`Solver`](ErrorKind::Solver),
    /// [`Internal`](ErrorKind::Internal). A map that is not injective is no error: see
    /// [`Parameterization`].
    ///
    /// # Panics
    ///
    /// Where the progress closure does, with what it panics with; the flattener can be used again.
    pub fn run(&mut self, control: Control<'_>) -> Result<Parameterization<'_>, Error> {
        let mut trampoline = Trampoline::new(control.progress);
        // SAFETY: the guard goes before this function ends, the context later.
        let Some(watch) = (unsafe { control.token.watch(self.context.handle()) }) else {
            return Err(Error::new(ErrorKind::Cancelled, "the run was cancelled before it began"));
        };
        let mut status = self.run_raw(&mut trampoline);
        let late_request = self.maybe_late_request
            && status == sys::BELTRAMI_E_CANCELLED
            && !trampoline.broke
            && !self.context.host_has_panicked()
            && !control.token.is_cancelled();
        if late_request {
            status = self.run_raw(&mut trampoline); // the request is used up
        }
        drop(watch);
        self.maybe_late_request = control.token.is_cancelled();
        if let Some(payload) = trampoline.panic.take() {
            drop(trampoline); // not while a panic is on its way, or another one would abort
            resume_unwind(payload);
        }
        self.context.check(status)?;
        Ok(Parameterization::new(&self.context))
    }

    fn run_raw(&mut self, trampoline: &mut Trampoline<'_>) -> sys::beltrami_status {
        let entry = trampoline.entry();
        let user = ptr::from_mut(trampoline).cast();
        // SAFETY: the context is alive, and the trampoline is what `entry` expects as `user`.
        unsafe { sys::beltrami_run(self.context.raw(), entry, user) }
    }

    /// Sets a mesh and flattens it.
    ///
    /// # Errors
    ///
    /// As [`set_mesh`](Self::set_mesh) and [`run`](Self::run).
    pub fn flatten(&mut self, mesh: &Mesh<'_>) -> Result<Parameterization<'_>, Error> {
        self.flatten_with(mesh, Control::new())
    }

    /// Sets a mesh and flattens it, watched and ended by `control`.
    ///
    /// # Errors
    ///
    /// As [`set_mesh`](Self::set_mesh) and [`run`](Self::run).
    ///
    /// # Panics
    ///
    /// As [`run`](Self::run).
    pub fn flatten_with(
        &mut self,
        mesh: &Mesh<'_>,
        control: Control<'_>,
    ) -> Result<Parameterization<'_>, Error> {
        self.set_mesh(mesh)?;
        self.run(control)
    }

    /// The results of the last run, or `None` before there are any.
    pub fn parameterization(&self) -> Option<Parameterization<'_>> {
        let mut result = sys::beltrami_result {
            struct_size: size_of::<sys::beltrami_result>() as u32,
            ..Default::default()
        };
        // SAFETY: the context is alive, and `result` has the size that it says.
        let status = unsafe { sys::beltrami_get_result(self.context.raw(), &mut result) };
        (status == sys::BELTRAMI_OK).then(|| Parameterization::new(&self.context))
    }
}
