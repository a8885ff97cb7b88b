//! What lies on the pages of a texture.

use std::ffi::c_void;
use std::fmt;
use std::mem::size_of;

use beltrami_sys as sys;

use crate::atlas_report::AtlasCertificate;
use crate::context::Context;
use crate::error::Error;
use crate::parameterization::Status;
use crate::verdict::count;

/// What a mask says of a texel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Texel {
    /// Nothing is near.
    Free,
    /// No further than the margin that was asked for from a covered one.
    Gutter,
    /// A face has a point in common with it.
    Covered,
}

/// Counts, density, margin and cost of what was packed.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PageSummary {
    /// Pieces that were moved.
    pub charts: usize,
    /// Faces of all charts.
    pub triangles: usize,
    /// Square pages of a texture.
    pub pages: usize,
    /// Texels to the side of a page.
    pub resolution: usize,
    /// Texels per unit of the surface, or without positions of the UVs that were packed.
    pub texels_per_unit: f64,
    /// Area of the UVs over that of the pages.
    pub utilisation: f64,
    /// Texels: the least of the distances of two charts and of twice those to the edges of pages, in
    /// the numbers that are delivered.
    pub margin: f64,
    /// Wall time of the call.
    pub seconds: f64,
    /// Processor time of the whole process during the call.
    pub cpu_seconds: f64,
    /// Charts that were made two of, with
    /// [`UnwrapOptions::fill_weight`](crate::UnwrapOptions::fill_weight).
    pub splits: usize,
    /// Length of the seams of those, in roots of the surface's area.
    pub split_length: f64,
    /// Utilisation without splits; the same where there are none.
    pub unsplit_utilisation: f64,
}

/// Charts on pages: of an [`Atlas`](crate::Atlas), or of a [`Packer`](crate::Packer).
#[derive(Clone, Copy)]
#[must_use = "a packing may be one that is not injective: see its status"]
pub struct Packing<'a> {
    context: &'a Context,
}

impl fmt::Debug for Packing<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Packing").field("summary", &self.summary()).finish_non_exhaustive()
    }
}

impl<'a> Packing<'a> {
    /// The context has packed something.
    pub(crate) fn new(context: &'a Context) -> Self {
        Packing { context }
    }

    /// What the run returned.
    pub fn status(&self) -> Status {
        Status::from_raw(self.raw().status)
    }

    /// Whether what lies on the pages is injective, by proof, in double precision.
    pub fn is_injective(&self) -> bool {
        self.certificate().injective
    }

    /// Counts, density, margin and cost.
    pub fn summary(&self) -> PageSummary {
        let raw = self.raw();
        PageSummary {
            charts: count(raw.charts),
            triangles: count(raw.triangles),
            pages: count(raw.pages),
            resolution: count(raw.resolution),
            texels_per_unit: raw.texels_per_unit,
            utilisation: raw.utilisation,
            margin: raw.margin,
            seconds: raw.seconds,
            cpu_seconds: raw.cpu_seconds,
            splits: count(raw.splits),
            split_length: raw.split_length,
            unsplit_utilisation: raw.unsplit_utilisation,
        }
    }

    /// The share of each page that charts cover.
    pub fn page_utilisations(&self) -> Vec<f64> {
        let mut shares = vec![0.0; count(self.raw().pages)];
        let out = shares.as_mut_ptr().cast::<c_void>();
        // SAFETY: there is room for a double per page.
        self.read(|context| unsafe {
            sys::beltrami_get_page_utilisations(context, out, sys::BELTRAMI_F64, 0)
        });
        shares
    }

    /// The page of each chart, counted from 0.
    pub fn chart_pages(&self) -> Vec<usize> {
        let mut pages = vec![0_u64; count(self.raw().charts)];
        let out = pages.as_mut_ptr().cast::<c_void>();
        // SAFETY: there is room for a number per chart.
        self.read(|context| unsafe {
            sys::beltrami_get_chart_pages(context, out, sys::BELTRAMI_U64, 0)
        });
        pages.into_iter().map(count).collect()
    }

    /// The certificate of the UVs in double precision. Faces count through all meshes.
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
            sys::beltrami_get_packing_certificate(context, scalar, &mut raw)
        });
        AtlasCertificate::new(&raw)
    }

    /// The texels of a page, as many to a row as rows, from the top (v = 1) down.
    ///
    /// # Errors
    ///
    /// [`InvalidArgument`](crate::ErrorKind::InvalidArgument) where there is no such page;
    /// [`OutOfMemory`](crate::ErrorKind::OutOfMemory).
    pub fn mask(&self, page: usize) -> Result<Vec<Texel>, Error> {
        let side = count(self.raw().resolution);
        let mut bytes = vec![0_u8; side * side];
        // SAFETY: there is room for a byte per texel.
        let status = unsafe {
            let out = bytes.as_mut_ptr();
            sys::beltrami_get_page_mask(self.context.raw(), page as u64, out, 0)
        };
        self.context.check(status)?;
        let texel = |byte: u8| match i32::from(byte) {
            sys::BELTRAMI_TEXEL_COVERED => Texel::Covered,
            sys::BELTRAMI_TEXEL_GUTTER => Texel::Gutter,
            _ => Texel::Free,
        };
        Ok(bytes.into_iter().map(texel).collect())
    }

    fn raw(&self) -> sys::beltrami_packing {
        let mut raw = sys::beltrami_packing {
            struct_size: size_of::<sys::beltrami_packing>() as u32,
            ..Default::default()
        };
        // SAFETY: `raw` has the size that it says.
        self.read(|context| unsafe { sys::beltrami_get_packing(context, &mut raw) });
        raw
    }

    fn read(&self, call: impl FnOnce(*mut sys::beltrami_context) -> sys::beltrami_status) {
        let read = self.context.check(call(self.context.raw()));
        read.expect("the library hands out the results that it has");
    }
}
