//! What a run has to show.

use std::fmt;
use std::mem::size_of;

use beltrami_sys as sys;

use crate::context::Context;
use crate::error::{advice, static_text, Error, ErrorKind};
use crate::mesh::{Uv, UvsMut};
use crate::verdict::{count, element, Certificate, Distortion};
use crate::view::WideIndex;

/// What a run with a result says of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
#[must_use = "a map may be one that is not injective"]
pub enum Status {
    /// All promises kept: the map is injective, by proof.
    Injective,
    /// The map is injective, but an optimisation stopped at its iteration limit.
    NotConverged,
    /// The exact certificate found flips, zero areas or boundary crossings.
    NotInjective,
    /// With the option `float32`: the map is injective in double precision, but no rounding to
    /// single precision was found that is. The UVs are the best one found.
    NotInjectiveFloat32,
    /// A reservation that a newer library has and this crate does not know.
    Other(i32),
}

impl Status {
    pub(crate) fn from_raw(status: sys::beltrami_status) -> Status {
        match status {
            sys::BELTRAMI_OK => Status::Injective,
            sys::BELTRAMI_NOT_CONVERGED => Status::NotConverged,
            sys::BELTRAMI_NOT_INJECTIVE => Status::NotInjective,
            sys::BELTRAMI_NOT_INJECTIVE_FLOAT32 => Status::NotInjectiveFloat32,
            other => Status::Other(other),
        }
    }

    /// The number in the C interface, a `beltrami_status`.
    pub fn raw(self) -> i32 {
        match self {
            Status::Injective => sys::BELTRAMI_OK,
            Status::NotConverged => sys::BELTRAMI_NOT_CONVERGED,
            Status::NotInjective => sys::BELTRAMI_NOT_INJECTIVE,
            Status::NotInjectiveFloat32 => sys::BELTRAMI_NOT_INJECTIVE_FLOAT32,
            Status::Other(status) => status,
        }
    }

    /// One sentence on what it means and what to do about it.
    pub fn advice(self) -> &'static str {
        advice(self.raw())
    }
}

/// Counts and costs of a run.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Summary {
    /// Vertices of the input.
    pub vertices: usize,
    /// Faces of the input.
    pub faces: usize,
    /// Edges of the boundary loop.
    pub boundary_edges: usize,
    /// Vertices that no face uses: their UV is (0, 0).
    pub unreferenced_vertices: usize,
    /// Faces of the simplified mesh.
    pub coarse_faces: usize,
    /// Faces that were not positive before repair.
    pub flips_before_repair: usize,
    /// Area of the input, in its unit squared.
    pub area: f64,
    /// Wall time of the run.
    pub seconds: f64,
    /// Processor time of the whole process during the run.
    pub cpu_seconds: f64,
    /// The most memory that the whole process has had so far.
    pub peak_memory_bytes: u64,
    /// Vertices that repair moved into the kernel of their one-ring.
    pub kernel_fixes: usize,
    /// Patches that repair untangled.
    pub patch_fixes: usize,
    /// Layouts that repair embedded anew, with a scaffold.
    pub global_fixes: usize,
    /// Patches optimised around faces of enormous energy.
    pub cleaned_patches: usize,
    /// Tries with a coarser mesh, after a map that was not injective.
    pub restarts: usize,
    /// Vertices that are not at the nearest float in single precision.
    pub float32_moves: usize,
    /// With the option `delaunay`: edges flipped.
    pub delaunay_flips: usize,
    /// With the option `delaunay`: edges whose flip would repeat an edge.
    pub delaunay_refused: usize,
    /// Faces of the input without area, which no energy counts.
    pub degenerate_faces: usize,
    /// The first of them.
    pub first_degenerate_face: Option<usize>,
    /// Mean energy of the coarse map; 0 where there was none.
    pub coarse_energy: f64,
}

impl Summary {
    fn new(raw: &sys::beltrami_result) -> Summary {
        Summary {
            vertices: count(raw.vertices),
            faces: count(raw.faces),
            boundary_edges: count(raw.boundary_edges),
            unreferenced_vertices: count(raw.unreferenced_vertices),
            coarse_faces: count(raw.coarse_faces),
            flips_before_repair: count(raw.flips_before_repair),
            area: raw.area,
            seconds: raw.seconds,
            cpu_seconds: raw.cpu_seconds,
            peak_memory_bytes: raw.peak_memory_bytes,
            kernel_fixes: count(raw.kernel_fixes),
            patch_fixes: count(raw.patch_fixes),
            global_fixes: count(raw.global_fixes),
            cleaned_patches: count(raw.cleaned_patches),
            restarts: count(raw.restarts),
            float32_moves: count(raw.float32_moves),
            delaunay_flips: count(raw.delaunay_flips),
            delaunay_refused: count(raw.delaunay_refused),
            degenerate_faces: count(raw.degenerate_faces),
            first_degenerate_face: element(raw.first_degenerate_face),
            coarse_energy: raw.coarse_energy,
        }
    }
}

/// Cost of one stage of a run.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Stage {
    /// `"simplify"`, `"coarse"`, `"prolong"`, `"flatten"`, `"repair"`, ...
    pub name: &'static str,
    /// 0 where the stage does not iterate.
    pub iterations: u32,
    /// Wall time.
    pub seconds: f64,
    /// Processor time of the whole process.
    pub cpu_seconds: f64,
}

impl Stage {
    /// An empty one for the library to fill.
    pub(crate) fn raw() -> sys::beltrami_stage {
        sys::beltrami_stage {
            struct_size: size_of::<sys::beltrami_stage>() as u32,
            ..Default::default()
        }
    }

    /// # Safety
    ///
    /// `raw` is one that the library has filled.
    pub(crate) unsafe fn new(raw: &sys::beltrami_stage) -> Stage {
        Stage {
            // SAFETY: the caller's promise; the names of stages are static texts.
            name: unsafe { static_text(raw.name) },
            iterations: raw.iterations.try_into().unwrap_or(0),
            seconds: raw.seconds,
            cpu_seconds: raw.cpu_seconds,
        }
    }
}

/// A map of a mesh to the plane: the results of a flattener's last run, read from it on demand.
///
/// A run that ends with a reservation has a result all the same, the best map that was found, and
/// so it is `Ok`. Whoever only wants to look at a map can. [`status`](Self::status) tells.
/// [`ensure_injective`](Self::ensure_injective) makes an error of a map that is not injective.
/// [`ensure_float32_injective`](Self::ensure_float32_injective) does so for UVs in single precision:
///
/// ```
/// # use beltrami::{Flattener, Mesh};
/// # let positions = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 1.0], [0.0, 1.0, 0.0]];
/// # let faces = [[0_u32, 1, 2], [0, 2, 3]];
/// # let mesh = Mesh::new(&positions, &faces);
/// # let mut flattener = Flattener::new()?;
/// let uvs: Vec<[f32; 2]> = flattener.flatten(&mesh)?.ensure_float32_injective()?.uvs();
/// # Ok::<(), beltrami::Error>(())
/// ```
#[derive(Clone, Copy)]
#[must_use = "a map may be one that is not injective: see its status, or call ensure_injective"]
pub struct Parameterization<'a> {
    context: &'a Context,
}

impl fmt::Debug for Parameterization<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("Parameterization")
            .field("status", &self.status())
            .field("certificate", &self.certificate())
            .field("distortion", &self.distortion())
            .finish_non_exhaustive()
    }
}

impl<'a> Parameterization<'a> {
    /// The context has results.
    pub(crate) fn new(context: &'a Context) -> Self {
        Parameterization { context }
    }

    /// What the run returned.
    pub fn status(&self) -> Status {
        Status::from_raw(self.result().status)
    }

    /// Whether the map is injective, by proof, as [`uvs`](Self::uvs) returns it in double
    /// precision.
    pub fn is_injective(&self) -> bool {
        self.certificate().injective
    }

    /// The map itself if it is injective in the precision that was asked for, converged or not.
    ///
    /// # Errors
    ///
    /// [`NotInjective`](ErrorKind::NotInjective), with a face that is not positive or a vertex where
    /// the boundary crosses itself; with the option `float32`
    /// [`NotInjectiveFloat32`](ErrorKind::NotInjectiveFloat32).
    pub fn ensure_injective(self) -> Result<Self, Error> {
        self.ensure(&self.certificate())
    }

    /// The map itself if it is injective as [`uvs`](Self::uvs) returns it in single precision,
    /// whether the option `float32` asked for that or not.
    ///
    /// # Errors
    ///
    /// As of [`ensure_injective`](Self::ensure_injective), and
    /// [`NotInjectiveFloat32`](ErrorKind::NotInjectiveFloat32) where the map is injective in double
    /// precision alone.
    pub fn ensure_float32_injective(self) -> Result<Self, Error> {
        self.ensure(&self.float32_certificate())
    }

    /// The map itself if the certificate, one of its own, says that it is injective.
    fn ensure(self, certificate: &Certificate) -> Result<Self, Error> {
        if certificate.injective {
            return Ok(self);
        }
        let double = self.is_injective() || self.status() == Status::NotInjectiveFloat32;
        let kind = if double { ErrorKind::NotInjectiveFloat32 } else { ErrorKind::NotInjective };
        Err(Error::from_status(kind.status(), certificate.bad_element()))
    }

    /// One (u, v) for every vertex, in the order of the vertices: in the mesh's unit of length, or
    /// with the option `unit_square` in the unit square.
    ///
    /// Single precision is rounded to nearest, but for the vertices that must move a little further
    /// for the map to stay injective: [`float32_certificate`](Self::float32_certificate) tells
    /// whether it did, and [`ensure_float32_injective`](Self::ensure_float32_injective) makes sure.
    pub fn uvs<T: Uv>(&self) -> Vec<T> {
        let mut uvs = vec![T::origin(); count(self.result().vertices)];
        self.fill_uvs(T::room(&mut uvs));
        uvs
    }

    /// Writes what [`uvs`](Self::uvs) returns into memory of the caller's.
    ///
    /// # Errors
    ///
    /// [`InvalidArgument`](ErrorKind::InvalidArgument) where there is not room for one UV per
    /// vertex, neither more nor less; nothing is written then.
    pub fn write_uvs<'b>(&self, room: impl Into<UvsMut<'b>>) -> Result<(), Error> {
        let room = room.into();
        let vertices = count(self.result().vertices);
        if room.len() != vertices {
            return Err(Error::argument(format!(
                "there is room for {} UVs, and there are {vertices}: give room for one per vertex",
                room.len()
            )));
        }
        self.fill_uvs(room);
        Ok(())
    }

    /// Writes the UVs; there is room for one per vertex.
    fn fill_uvs(&self, room: UvsMut<'_>) {
        let (out, scalar, stride) = (room.0.first, room.0.scalar, room.0.stride as u64);
        // SAFETY: there is room for a UV of this type at every stride, one per vertex.
        self.read(|context| unsafe { sys::beltrami_get_uvs(context, out, scalar, stride) });
    }

    /// The certificate of the UVs in double precision.
    pub fn certificate(&self) -> Certificate {
        let mut raw = Certificate::raw();
        // SAFETY: `raw` has the size that it says.
        self.read(|context| unsafe { sys::beltrami_get_certificate(context, &mut raw) });
        Certificate::new(&raw)
    }

    /// The certificate of the UVs in single precision.
    pub fn float32_certificate(&self) -> Certificate {
        let mut raw = Certificate::raw();
        // SAFETY: `raw` has the size that it says.
        self.read(|context| unsafe { sys::beltrami_get_float32_certificate(context, &mut raw) });
        Certificate::new(&raw)
    }

    /// The triangles that the map, its certificates and its face energies speak of: the input's, or
    /// with the option `delaunay` those of the intrinsic Delaunay triangulation on the same
    /// vertices. Indices are `u32` or `u64`.
    pub fn faces<T: WideIndex>(&self) -> Vec<[T; 3]> {
        let mut faces = vec![[T::default(); 3]; count(self.result().faces)];
        let out = faces.as_mut_ptr().cast();
        // SAFETY: there is room for three indices of this type per face.
        self.read(|context| unsafe { sys::beltrami_get_faces(context, out, T::TYPE, 0) });
        faces
    }

    /// Energies of the UVs in double precision.
    pub fn distortion(&self) -> Distortion {
        let mut raw = Distortion::raw();
        // SAFETY: `raw` has the size that it says.
        self.read(|context| unsafe { sys::beltrami_get_energy(context, &mut raw) });
        Distortion::new(&raw)
    }

    /// Symmetric Dirichlet energy of every face of [`faces`](Self::faces), at least 2; infinite
    /// where a face is flipped, degenerate, or without 3D area. For the singular values and the
    /// symmetric ARAP energy see [`measure_faces`](crate::measure_faces).
    pub fn face_energies(&self) -> Vec<f64> {
        let mut energies = vec![0.0; count(self.result().faces)];
        let out = energies.as_mut_ptr().cast();
        // SAFETY: there is room for one number per face.
        self.read(|context| unsafe { sys::beltrami_get_face_energies(context, out, 0) });
        energies
    }

    /// Counts and costs.
    pub fn summary(&self) -> Summary {
        Summary::new(&self.result())
    }

    /// The costs of every stage, in the order in which they ran.
    pub fn stages(&self) -> Vec<Stage> {
        // SAFETY: the context is alive.
        let stages = unsafe { sys::beltrami_stage_count(self.context.raw()) };
        (0..stages).map(|index| self.stage(index)).collect()
    }

    fn stage(&self, index: i32) -> Stage {
        let mut raw = Stage::raw();
        // SAFETY: `raw` has the size that it says.
        self.read(|context| unsafe { sys::beltrami_get_stage(context, index, &mut raw) });
        // SAFETY: it was filled.
        unsafe { Stage::new(&raw) }
    }

    fn result(&self) -> sys::beltrami_result {
        let mut raw = sys::beltrami_result {
            struct_size: size_of::<sys::beltrami_result>() as u32,
            ..Default::default()
        };
        // SAFETY: `raw` has the size that it says.
        self.read(|context| unsafe { sys::beltrami_get_result(context, &mut raw) });
        raw
    }

    /// Reads from the context, which cannot fail where there are results and the arguments are in
    /// order.
    fn read(&self, call: impl FnOnce(*mut sys::beltrami_context) -> sys::beltrami_status) {
        let read = self.context.check(call(self.context.raw()));
        read.expect("the library hands out the results that it has");
    }
}
