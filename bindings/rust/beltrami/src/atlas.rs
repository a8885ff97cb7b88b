//! What unwrapping has to show.

use std::ffi::c_void;
use std::fmt;
use std::mem::size_of;

use beltrami_sys as sys;

use crate::atlas_report::{AtlasCertificate, AtlasSummary, Chart};
use crate::context::Context;
use crate::error::{Error, ErrorKind};
use crate::mesh::{Uv, UvsMut};
use crate::packing::Packing;
use crate::parameterization::{Stage, Status};
use crate::verdict::count;
use crate::view::WideIndex;

/// The UVs of a surface that was cut into charts: the results of an unwrapper's last run, read from
/// it on demand.
///
/// UV vertices are vertices of the input, split along the seams and nowhere else: [`uvs`](Self::uvs)
/// and [`corner_uv_vertices`](Self::corner_uv_vertices) are what a vertex buffer and its index buffer
/// hold, and [`split`](Self::split) copies whatever else the vertices have.
///
/// A run that ends with a reservation has a result all the same: [`status`](Self::status) tells, the
/// [`charts`](Self::charts) say where, and [`ensure_injective`](Self::ensure_injective) makes an
/// error of an atlas that is not injective.
#[derive(Clone, Copy)]
#[must_use = "an atlas may be one that is not injective: see its status, or call ensure_injective"]
pub struct Atlas<'a> {
    context: &'a Context,
}

impl fmt::Debug for Atlas<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("Atlas")
            .field("status", &self.status())
            .field("certificate", &self.certificate())
            .field("summary", &self.summary())
            .finish_non_exhaustive()
    }
}

impl<'a> Atlas<'a> {
    /// The context has an atlas.
    pub(crate) fn new(context: &'a Context) -> Self {
        Atlas { context }
    }

    /// What the run returned.
    pub fn status(&self) -> Status {
        Status::from_raw(self.raw().status)
    }

    /// Whether the atlas is injective, by proof, as [`uvs`](Self::uvs) returns it in double
    /// precision.
    pub fn is_injective(&self) -> bool {
        self.certificate().injective
    }

    /// The atlas itself if it is injective in the precision that was asked for, converged or not.
    ///
    /// # Errors
    ///
    /// [`NotInjective`](ErrorKind::NotInjective), with a face that is not positive or that overlaps
    /// another; with the option `float32` [`NotInjectiveFloat32`](ErrorKind::NotInjectiveFloat32).
    pub fn ensure_injective(self) -> Result<Self, Error> {
        self.ensure(&self.certificate())
    }

    /// The atlas itself if it is injective as [`uvs`](Self::uvs) returns it in single precision.
    /// [`UnwrapOptions::float32`](crate::UnwrapOptions::float32) sees to it.
    ///
    /// # Errors
    ///
    /// As of [`ensure_injective`](Self::ensure_injective), and
    /// [`NotInjectiveFloat32`](ErrorKind::NotInjectiveFloat32) where the atlas is injective in
    /// double precision alone.
    pub fn ensure_float32_injective(self) -> Result<Self, Error> {
        self.ensure(&self.float32_certificate())
    }

    /// The atlas itself if the certificate, one of its own, says that it is injective.
    fn ensure(self, certificate: &AtlasCertificate) -> Result<Self, Error> {
        if certificate.injective {
            return Ok(self);
        }
        let double = self.is_injective() || self.status() == Status::NotInjectiveFloat32;
        let kind = if double { ErrorKind::NotInjectiveFloat32 } else { ErrorKind::NotInjective };
        Err(Error::from_status(kind.status(), certificate.bad_element()))
    }

    /// One (u, v) for every UV vertex, in the unit square of its page. With
    /// [`Pack::None`](crate::Pack::None), and with pins, they are in the surface's unit of length, or
    /// with the option `unit_square` in the unit square. Single precision is rounded to nearest.
    pub fn uvs<T: Uv>(&self) -> Vec<T> {
        let mut uvs = vec![T::origin(); count(self.raw().uv_vertices)];
        self.fill(T::room(&mut uvs), sys::beltrami_get_uv_vertices);
        uvs
    }

    /// Writes what [`uvs`](Self::uvs) returns into memory of the caller's.
    ///
    /// # Errors
    ///
    /// [`InvalidArgument`](ErrorKind::InvalidArgument) where there is not room for one UV per UV
    /// vertex, neither more nor less; nothing is written then.
    pub fn write_uvs<'b>(&self, room: impl Into<UvsMut<'b>>) -> Result<(), Error> {
        let room = require_room(room.into(), count(self.raw().uv_vertices), "UV vertex")?;
        self.fill(room, sys::beltrami_get_uv_vertices);
        Ok(())
    }

    /// One (u, v) for every corner, face after face.
    pub fn corner_uvs<T: Uv>(&self) -> Vec<T> {
        let mut uvs = vec![T::origin(); count(self.raw().corners)];
        self.fill(T::room(&mut uvs), sys::beltrami_get_corner_uvs);
        uvs
    }

    /// Writes what [`corner_uvs`](Self::corner_uvs) returns into memory of the caller's.
    ///
    /// # Errors
    ///
    /// [`InvalidArgument`](ErrorKind::InvalidArgument) where there is not room for one UV per
    /// corner, neither more nor less; nothing is written then.
    pub fn write_corner_uvs<'b>(&self, room: impl Into<UvsMut<'b>>) -> Result<(), Error> {
        let room = require_room(room.into(), count(self.raw().corners), "corner")?;
        self.fill(room, sys::beltrami_get_corner_uvs);
        Ok(())
    }

    /// The UV vertex of every corner, face after face: an index buffer, in `u32` or `u64`.
    pub fn corner_uv_vertices<T: WideIndex>(&self) -> Vec<T> {
        self.numbers(count(self.raw().corners), sys::beltrami_get_corner_uv_vertices)
    }

    /// The page of every corner's UV, face after face, in `u32` or `u64`; 0 where the atlas is not
    /// packed. As tiles of UDIM page k is 1001 + k: u is greater by k % 10 there, v by k / 10.
    pub fn corner_pages<T: WideIndex>(&self) -> Vec<T> {
        self.numbers(count(self.raw().corners), sys::beltrami_get_corner_pages)
    }

    /// What lies on the pages; `None` where the atlas is not packed.
    pub fn packing(&self) -> Option<Packing<'a>> {
        (self.raw().pages > 0).then(|| Packing::new(self.context))
    }

    /// The vertex of the input that every UV vertex is a copy of, in `u32` or `u64`.
    pub fn origins<T: WideIndex>(&self) -> Vec<T> {
        self.numbers(count(self.raw().uv_vertices), sys::beltrami_get_uv_vertex_origins)
    }

    /// What each UV vertex has of `items`, one per vertex of the input: positions, normals, whole
    /// vertices.
    ///
    /// # Panics
    ///
    /// Where there are fewer items than vertices.
    pub fn split<T: Clone>(&self, items: &[T]) -> Vec<T> {
        self.origins::<u64>().into_iter().map(|vertex| items[count(vertex)].clone()).collect()
    }

    /// The seams, those given and those found, as pairs of vertices in `u32` or `u64`. They are
    /// edges at which UVs part, each once, the lesser vertex first, in increasing order. Open borders
    /// are none. Of
    /// vertices that count as one it is the least. As [`seams`](crate::Surface::seams) of the
    /// surface, with [`Cut::Given`](crate::Cut::Given), they make the same charts.
    pub fn seams<T: WideIndex>(&self) -> Vec<[T; 2]> {
        let mut seams = vec![[T::default(); 2]; count(self.raw().seams)];
        let out = seams.as_mut_ptr().cast();
        // SAFETY: there is room for two numbers of this type per seam.
        self.read(|context| unsafe { sys::beltrami_get_seams(context, out, T::TYPE, 0) });
        seams
    }

    /// Whether the atlas is what its seams were searched for: in energy (to 0.0001), 99th
    /// percentile, charts (or one for each component) and length of seams. `None` where none were
    /// searched for.
    pub fn reached_target(&self) -> Option<bool> {
        let raw = self.raw();
        (raw.searched != 0).then_some(raw.reached != 0)
    }

    /// The triangles that were computed on and that the certificates speak of: three corners each,
    /// in the orientation in which they are positive, in `u32` or `u64`.
    pub fn triangles<T: WideIndex>(&self) -> Vec<[T; 3]> {
        let mut triangles = vec![[T::default(); 3]; count(self.raw().triangles)];
        let out = triangles.as_mut_ptr().cast();
        // SAFETY: there is room for three numbers of this type per triangle.
        self.read(|context| unsafe { sys::beltrami_get_triangles(context, out, T::TYPE, 0) });
        triangles
    }

    /// The chart of every face; `None` for one without area.
    pub fn face_charts(&self) -> Vec<Option<usize>> {
        let charts = self.numbers(count(self.raw().faces), sys::beltrami_get_face_charts);
        charts.into_iter().map(crate::verdict::element).collect()
    }

    /// The charts, in the order of their least faces.
    pub fn charts(&self) -> Vec<Chart> {
        (0..self.raw().charts).map(|index| self.chart(index)).collect()
    }

    fn chart(&self, index: u64) -> Chart {
        let mut raw = sys::beltrami_chart {
            struct_size: size_of::<sys::beltrami_chart>() as u32,
            ..Default::default()
        };
        // SAFETY: `raw` has the size that it says.
        self.read(|context| unsafe { sys::beltrami_get_chart(context, index, &mut raw) });
        Chart::new(&raw)
    }

    /// The certificate of the UVs in double precision.
    pub fn certificate(&self) -> AtlasCertificate {
        self.certificate_of(sys::BELTRAMI_F64)
    }

    /// The certificate of the UVs in single precision.
    pub fn float32_certificate(&self) -> AtlasCertificate {
        self.certificate_of(sys::BELTRAMI_F32)
    }

    fn certificate_of(&self, scalar: i32) -> AtlasCertificate {
        let mut raw = AtlasCertificate::raw();
        // SAFETY: `raw` has the size that it says.
        self.read(|context| unsafe {
            sys::beltrami_get_atlas_certificate(context, scalar, &mut raw)
        });
        AtlasCertificate::new(&raw)
    }

    /// Counts, energy and costs.
    pub fn summary(&self) -> AtlasSummary {
        AtlasSummary::new(&self.raw())
    }

    /// The costs of every stage, in the order in which they ran.
    pub fn stages(&self) -> Vec<Stage> {
        // SAFETY: the context is alive.
        let stages = unsafe { sys::beltrami_atlas_stage_count(self.context.raw()) };
        let stage = |index| {
            let mut raw = Stage::raw();
            // SAFETY: `raw` has the size that it says.
            self.read(|context| unsafe { sys::beltrami_get_atlas_stage(context, index, &mut raw) });
            // SAFETY: it was filled.
            unsafe { Stage::new(&raw) }
        };
        (0..stages).map(stage).collect()
    }

    fn raw(&self) -> sys::beltrami_atlas {
        let mut raw = sys::beltrami_atlas {
            struct_size: size_of::<sys::beltrami_atlas>() as u32,
            ..Default::default()
        };
        // SAFETY: `raw` has the size that it says.
        self.read(|context| unsafe { sys::beltrami_get_atlas(context, &mut raw) });
        raw
    }

    /// Writes UVs; there is room for as many as `get` writes.
    fn fill(&self, room: UvsMut<'_>, get: Get) {
        let (out, scalar, stride) = (room.0.first, room.0.scalar, room.0.stride as u64);
        // SAFETY: there is room for a UV of this type at every stride.
        self.read(|context| unsafe { get(context, out, scalar, stride) });
    }

    /// As many lone numbers as `get` writes.
    fn numbers<T: WideIndex>(&self, len: usize, get: Get) -> Vec<T> {
        let mut numbers = vec![T::default(); len];
        let out = numbers.as_mut_ptr().cast();
        // SAFETY: there is room for `len` numbers of this type.
        self.read(|context| unsafe { get(context, out, T::TYPE, 0) });
        numbers
    }

    /// Reads from the context, which cannot fail where there is an atlas and the arguments are in
    /// order.
    fn read(&self, call: impl FnOnce(*mut sys::beltrami_context) -> sys::beltrami_status) {
        let read = self.context.check(call(self.context.raw()));
        read.expect("the library hands out the results that it has");
    }
}

/// A getter that writes to an array: its type and stride come last.
pub(crate) type Get =
    unsafe extern "C" fn(*mut sys::beltrami_context, *mut c_void, i32, u64) -> sys::beltrami_status;

/// Fails unless there is room for `len` UVs.
pub(crate) fn require_room<'a>(
    room: UvsMut<'a>,
    len: usize,
    each: &str,
) -> Result<UvsMut<'a>, Error> {
    if room.len() == len {
        return Ok(room);
    }
    Err(Error::argument(format!(
        "there is room for {} UVs, and there are {len}: give room for one per {each}",
        room.len()
    )))
}
