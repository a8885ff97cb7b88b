//! Unwraps: options, the atlas of the last surface.

use std::mem::size_of;
use std::panic::resume_unwind;
use std::ptr;

use beltrami_sys as sys;

use crate::atlas::Atlas;
use crate::context::Context;
use crate::control::{Control, Trampoline};
use crate::error::{Error, ErrorKind};
use crate::options::UnwrapOptions;
use crate::surface::Surface;

/// Cuts surfaces of any kind into charts and flattens these, one surface after the other, with the
/// same options.
///
/// Nothing is refused but indices out of range, numbers that are not finite, and surfaces without
/// any area. What is not manifold is parted, faces that disagree are turned, and every corner gets
/// its UV.
///
/// It may move to another thread, and is used by one thread at a time. Unwrappers share nothing: for
/// several surfaces at a time take one for each thread. It keeps the atlas of its last surface, until
/// it unwraps another one or goes.
///
/// ```
/// use beltrami::{Surface, UnwrapOptions, Unwrapper};
///
/// // A tetrahedron, which has no boundary.
/// let positions = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let faces = [[0_u32, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
///
/// let mut unwrapper = Unwrapper::with_options(&UnwrapOptions::new().float32(true))?;
/// let atlas = unwrapper.unwrap(&Surface::new(&positions, &faces))?.ensure_float32_injective()?;
/// let uvs: Vec<[f32; 2]> = atlas.corner_uvs(); // one for each corner of each face
/// # assert_eq!(uvs.len(), 12);
///
/// // What a vertex buffer needs: vertices split along the seams, and nowhere else.
/// let vertices: Vec<[f32; 3]> = atlas.split(&positions);
/// let uvs: Vec<[f32; 2]> = atlas.uvs();
/// let indices: Vec<u32> = atlas.corner_uv_vertices();
/// # assert_eq!((vertices.len(), indices.len()), (uvs.len(), 12));
/// # Ok::<(), beltrami::Error>(())
/// ```
///
/// It is not `Sync`, as a shared reference to it still writes to the context:
///
/// ```compile_fail,E0277
/// fn share(_: impl Sync) {}
/// share(beltrami::Unwrapper::new());
/// ```
///
/// An atlas borrows the unwrapper, which cannot run again while it is in use:
///
/// ```compile_fail,E0499
/// # use beltrami::{Surface, Unwrapper};
/// # fn twice(unwrapper: &mut Unwrapper, surface: &Surface<'_>) -> Result<(), beltrami::Error> {
/// let first = unwrapper.unwrap(surface)?;
/// let second = unwrapper.unwrap(surface)?;
/// first.uvs::<[f32; 2]>();
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Unwrapper {
    context: Context,
    options: UnwrapOptions,
}

impl Unwrapper {
    /// An unwrapper with default options.
    ///
    /// # Errors
    ///
    /// [`AbiMismatch`](ErrorKind::AbiMismatch) where the library at run time is another than this
    /// crate was built for; [`OutOfMemory`](ErrorKind::OutOfMemory).
    pub fn new() -> Result<Unwrapper, Error> {
        Ok(Unwrapper { context: Context::new()?, options: UnwrapOptions::new() })
    }

    /// An unwrapper with these options.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new) and [`set_options`](Self::set_options).
    pub fn with_options(options: &UnwrapOptions) -> Result<Unwrapper, Error> {
        let mut unwrapper = Unwrapper::new()?;
        unwrapper.set_options(options)?;
        Ok(unwrapper)
    }

    /// Takes these options for later surfaces; those that are not set in them are the defaults
    /// again. On failure the old ones stay.
    ///
    /// # Errors
    ///
    /// [`InvalidArgument`](ErrorKind::InvalidArgument) for a value that is out of range.
    pub fn set_options(&mut self, options: &UnwrapOptions) -> Result<(), Error> {
        self.context.replace(self.options.values(), options.values())?;
        self.options = options.clone();
        Ok(())
    }

    /// Runs loops on the caller's threads in place of the library's own: `closure` is given a count,
    /// at most that of the option `threads`, and a job to call once with each index below it, on any
    /// threads, before it returns. The result has the same bits. With rayon:
    ///
    /// ```
    /// # use beltrami::{UnwrapOptions, Unwrapper};
    /// use rayon::prelude::*;
    ///
    /// let mut unwrapper = Unwrapper::with_options(&UnwrapOptions::new().threads(4))?;
    /// unwrapper.run_loops_by(|count, job| (0..count).into_par_iter().for_each(job));
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

    /// Unwraps a surface. On failure the atlas of the last one stays.
    ///
    /// # Errors
    ///
    /// [`InvalidArgument`](ErrorKind::InvalidArgument) where lengths do not fit together, a face has
    /// less than three corners, or an option leaves another one without effect.
    /// [`Empty`](ErrorKind::Empty), [`IndexOutOfRange`](ErrorKind::IndexOutOfRange),
    /// [`NonFinite`](ErrorKind::NonFinite) and [`ZeroArea`](ErrorKind::ZeroArea), with the element
    /// that is the cause. [`OutOfMemory`](ErrorKind::OutOfMemory), [`Internal`](ErrorKind::Internal). An
    /// atlas that is not injective is no error: see [`Atlas`].
    pub fn unwrap(&mut self, surface: &Surface<'_>) -> Result<Atlas<'_>, Error> {
        self.unwrap_with(surface, Control::new())
    }

    /// Unwraps a surface, watched and ended by `control`.
    ///
    /// # Errors
    ///
    /// As [`unwrap`](Self::unwrap), and [`Cancelled`](ErrorKind::Cancelled) by `control`.
    ///
    /// # Panics
    ///
    /// Where the progress closure does, with what it panics with; the unwrapper can be used again.
    pub fn unwrap_with(
        &mut self,
        surface: &Surface<'_>,
        control: Control<'_>,
    ) -> Result<Atlas<'_>, Error> {
        let Control { progress, token } = control;
        if token.is_cancelled() {
            return Err(Error::new(ErrorKind::Cancelled, "the run was cancelled before it began"));
        }
        let raw = surface.raw(&token)?;
        let mut trampoline = Trampoline::new(progress);
        let entry = trampoline.entry();
        let user = ptr::from_mut(&mut trampoline).cast();
        // SAFETY: the context is alive; the views behind the surface are borrowed, all their items
        // are there, and there are as many as `raw` made sure of; the token lives longer; the
        // trampoline is what `entry` expects as `user`.
        let status = unsafe { sys::beltrami_unwrap(self.context.raw(), &raw, entry, user) };
        if let Some(payload) = trampoline.panic.take() {
            drop(trampoline); // not while a panic is on its way, or another one would abort
            resume_unwind(payload);
        }
        self.context.check(status)?;
        Ok(Atlas::new(&self.context))
    }

    /// The atlas of the last surface, or `None` before there is one.
    pub fn atlas(&self) -> Option<Atlas<'_>> {
        let mut atlas = sys::beltrami_atlas {
            struct_size: size_of::<sys::beltrami_atlas>() as u32,
            ..Default::default()
        };
        // SAFETY: the context is alive, and `atlas` has the size that it says.
        let status = unsafe { sys::beltrami_get_atlas(self.context.raw(), &mut atlas) };
        (status == sys::BELTRAMI_OK).then(|| Atlas::new(&self.context))
    }
}
