//! Packs: UV meshes onto the pages of a texture.

use std::mem::size_of;
use std::panic::resume_unwind;
use std::ptr;

use beltrami_sys as sys;

use crate::context::Context;
use crate::control::{CancelToken, Control, Trampoline};
use crate::error::{Error, ErrorKind};
use crate::mesh::{Faces, Positions, Uv, Uvs};
use crate::options::PackOptions;
use crate::packing::Packing;
use crate::surface::Integers;
use crate::verdict::count;

/// Triangles in the plane, borrowed. Triangles that share a UV vertex are of one chart.
#[derive(Debug, Clone, Copy)]
#[must_use = "give it to a Packer"]
pub struct UvMesh<'a> {
    uvs: Uvs<'a>,
    uv_faces: Faces<'a>,
    positions: Option<Positions<'a>>,
    faces: Option<Faces<'a>>,
    kept_pages: Option<Integers<'a>>,
    page_labels: Option<Integers<'a>>,
}

impl<'a> UvMesh<'a> {
    /// One (u, v) per UV vertex, and the UV vertices of each triangle.
    pub fn new(uvs: impl Into<Uvs<'a>>, uv_faces: impl Into<Faces<'a>>) -> UvMesh<'a> {
        UvMesh {
            uvs: uvs.into(),
            uv_faces: uv_faces.into(),
            positions: None,
            faces: None,
            kept_pages: None,
            page_labels: None,
        }
    }

    /// Positions in space: with them charts get equally many texels for equal areas, else they keep
    /// their sizes to each other. All meshes have them, or none; without
    /// [`faces`](Self::faces) UV vertices are vertices.
    pub fn positions(mut self, positions: impl Into<Positions<'a>>) -> Self {
        self.positions = Some(positions.into());
        self
    }

    /// With positions, the vertices of each triangle.
    pub fn faces(mut self, faces: impl Into<Faces<'a>>) -> Self {
        self.faces = Some(faces.into());
        self
    }

    /// For each triangle the page on which its chart stays where it is, in the unit square; the
    /// greatest number of the type (`u32::MAX`) where it is placed anew. The same for all triangles
    /// of a chart.
    pub fn kept_pages(mut self, pages: impl Into<Integers<'a>>) -> Self {
        self.kept_pages = Some(pages.into());
        self
    }

    /// A label for each triangle: charts of different labels get different pages, in the order of
    /// the labels. A chart has that of its first triangle. All meshes have labels, or none, and none
    /// has [`kept_pages`](Self::kept_pages).
    pub fn page_labels(mut self, labels: impl Into<Integers<'a>>) -> Self {
        self.page_labels = Some(labels.into());
        self
    }

    /// The library's description, which holds as long as the borrow and the token.
    fn raw(&self, token: &CancelToken) -> Result<sys::beltrami_uv_mesh, Error> {
        let faces = self.uv_faces.len();
        let lengths = [
            self.faces.map(|faces| faces.len()),
            self.kept_pages.map(|pages| pages.len()),
            self.page_labels.map(|labels| labels.len()),
        ];
        if let Some(other) = lengths.into_iter().flatten().find(|&length| length != faces) {
            return Err(Error::argument(format!(
                "there are {other} items for {faces} faces: give one per face"
            )));
        }
        Ok(sys::beltrami_uv_mesh {
            struct_size: size_of::<sys::beltrami_uv_mesh>() as u32,
            uv_count: self.uvs.len() as u64,
            face_count: faces as u64,
            uvs: self.uvs.0.raw(),
            uv_indices: self.uv_faces.0.raw(),
            vertex_count: self.positions.map_or(0, |positions| positions.len() as u64),
            positions: self.positions.map_or_else(Default::default, |p| p.0.raw()),
            indices: self.faces.map_or_else(Default::default, |f| f.0.raw()),
            kept_pages: self.kept_pages.map_or_else(Default::default, |k| k.0.raw()),
            page_labels: self.page_labels.map_or_else(Default::default, |l| l.0.raw()),
            cancel: token.number(),
            ..Default::default()
        })
    }
}

/// Packs UV meshes onto the pages of a texture, each chart moved, turned and scaled, none mirrored.
///
/// It may move to another thread, and is used by one thread at a time. It keeps what it packed last,
/// until it packs again or goes.
///
/// ```
/// use beltrami::{Packer, UvMesh};
///
/// // Two triangles, each a chart.
/// let uvs = [[0.0_f64, 0.0], [1.0, 0.0], [0.0, 1.0], [5.0, 0.0], [6.0, 0.0], [5.0, 1.0]];
/// let faces = [[0_u32, 1, 2], [3, 4, 5]];
/// let mut packer = Packer::new()?;
/// let packing = packer.pack(&[UvMesh::new(&uvs, &faces)])?;
/// assert!(packing.is_injective() && packing.summary().margin >= 2.0);
/// let packed: Vec<[f64; 2]> = packer.uvs(0); // one for each UV vertex
/// # assert_eq!(packed.len(), 6);
/// # Ok::<(), beltrami::Error>(())
/// ```
#[derive(Debug)]
pub struct Packer {
    context: Context,
    options: PackOptions,
    /// UV vertices and faces of each mesh.
    sizes: Vec<(usize, usize)>,
}

impl Packer {
    /// A packer with default options.
    ///
    /// # Errors
    ///
    /// [`AbiMismatch`](ErrorKind::AbiMismatch) where the library at run time is another than this
    /// crate was built for; [`OutOfMemory`](ErrorKind::OutOfMemory).
    pub fn new() -> Result<Packer, Error> {
        Ok(Packer { context: Context::new()?, options: PackOptions::new(), sizes: Vec::new() })
    }

    /// A packer with these options.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new) and [`set_options`](Self::set_options).
    pub fn with_options(options: &PackOptions) -> Result<Packer, Error> {
        let mut packer = Packer::new()?;
        packer.set_options(options)?;
        Ok(packer)
    }

    /// Takes these options for later meshes; those that are not set in them are the defaults again.
    /// On failure the old ones stay.
    ///
    /// # Errors
    ///
    /// [`InvalidArgument`](ErrorKind::InvalidArgument) for a value that is out of range.
    pub fn set_options(&mut self, options: &PackOptions) -> Result<(), Error> {
        self.context.replace(self.options.values(), options.values())?;
        self.options = options.clone();
        Ok(())
    }

    /// Packs meshes onto common pages. On failure what was packed last stays.
    ///
    /// # Errors
    ///
    /// [`InvalidArgument`](ErrorKind::InvalidArgument) where lengths do not fit together, or a chart
    /// cannot stay where it is; [`Empty`](ErrorKind::Empty),
    /// [`IndexOutOfRange`](ErrorKind::IndexOutOfRange), [`NonFinite`](ErrorKind::NonFinite), with the
    /// element; [`NoRoom`](ErrorKind::NoRoom), [`OutOfMemory`](ErrorKind::OutOfMemory),
    /// [`Internal`](ErrorKind::Internal). Charts that come folded or on themselves are no error: see
    /// [`Packing::status`].
    pub fn pack(&mut self, meshes: &[UvMesh<'_>]) -> Result<Packing<'_>, Error> {
        self.pack_with(meshes, Control::new())
    }

    /// Packs meshes, watched and ended by `control`.
    ///
    /// # Errors
    ///
    /// As [`pack`](Self::pack), and [`Cancelled`](ErrorKind::Cancelled) by `control`.
    ///
    /// # Panics
    ///
    /// Where the progress closure does, with what it panics with; the packer can be used again.
    pub fn pack_with(
        &mut self,
        meshes: &[UvMesh<'_>],
        control: Control<'_>,
    ) -> Result<Packing<'_>, Error> {
        let Control { progress, token } = control;
        if token.is_cancelled() {
            return Err(Error::new(ErrorKind::Cancelled, "the run was cancelled before it began"));
        }
        let raw = meshes.iter().map(|mesh| mesh.raw(&token)).collect::<Result<Vec<_>, _>>()?;
        let pointers: Vec<*const sys::beltrami_uv_mesh> = raw.iter().map(ptr::from_ref).collect();
        let mut trampoline = Trampoline::new(progress);
        let entry = trampoline.entry();
        let user = ptr::from_mut(&mut trampoline).cast();
        // SAFETY: the context is alive; the views behind the meshes are borrowed, all their items are
        // there; the token lives longer; the trampoline is what `entry` expects as `user`.
        let status = unsafe {
            let (first, len) = (pointers.as_ptr(), pointers.len() as u64);
            sys::beltrami_pack(self.context.raw(), first, len, entry, user)
        };
        if let Some(payload) = trampoline.panic.take() {
            drop(trampoline); // not while a panic is on its way, or another one would abort
            resume_unwind(payload);
        }
        self.context.check(status)?;
        self.sizes = meshes.iter().map(|mesh| (mesh.uvs.len(), mesh.uv_faces.len())).collect();
        Ok(Packing::new(&self.context))
    }

    /// What was packed last, or `None` before anything was.
    pub fn packing(&self) -> Option<Packing<'_>> {
        (!self.sizes.is_empty()).then(|| Packing::new(&self.context))
    }

    /// The new (u, v) of every UV vertex of a mesh, in the unit square of its chart's page; (0, 0)
    /// where no face uses it.
    ///
    /// # Panics
    ///
    /// Where there is no such mesh.
    pub fn uvs<T: Uv>(&self, mesh: usize) -> Vec<T> {
        let mut uvs = vec![T::origin(); self.sizes[mesh].0];
        let room = T::room(&mut uvs).0;
        // SAFETY: there is room for a UV of this type at every stride.
        let status = unsafe {
            let (context, stride) = (self.context.raw(), room.stride as u64);
            sys::beltrami_get_packed_uvs(context, mesh as u64, room.first, room.scalar, stride)
        };
        self.context.check(status).expect("the library hands out the results that it has");
        uvs
    }

    /// The chart of every face of a mesh: charts count through all meshes, by their first faces.
    ///
    /// # Panics
    ///
    /// Where there is no such mesh.
    pub fn face_charts(&self, mesh: usize) -> Vec<usize> {
        let mut charts = vec![0_u64; self.sizes[mesh].1];
        let out = charts.as_mut_ptr().cast();
        // SAFETY: there is room for a number per face.
        let status = unsafe {
            let context = self.context.raw();
            sys::beltrami_get_packed_charts(context, mesh as u64, out, sys::BELTRAMI_U64, 0)
        };
        self.context.check(status).expect("the library hands out the results that it has");
        charts.into_iter().map(count).collect()
    }
}
