//! Checks of any atlas, whoever made it, and the triangles of polygons.

use beltrami_sys as sys;

use crate::atlas_report::AtlasCertificate;
use crate::control::CancelToken;
use crate::error::{Element, Error};
use crate::surface::Surface;
use crate::verdict::element;
use crate::view::WideIndex;

/// What an atlas may do, and how much of what it does wrong is listed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[must_use = "builders return what they build"]
pub struct AtlasRules {
    allow_mirrored: bool,
    most_pairs: usize,
}

impl AtlasRules {
    /// No mirrored charts, and no list.
    pub fn new() -> AtlasRules {
        AtlasRules::default()
    }

    /// Takes charts that are negative as a whole for their mirror images.
    pub fn allow_mirrored(mut self, yes: bool) -> Self {
        self.allow_mirrored = yes;
        self
    }

    /// Lists at most so many overlaps.
    pub fn most_pairs(mut self, pairs: usize) -> Self {
        self.most_pairs = pairs;
        self
    }
}

/// The verdict on an atlas, with faces that overlap.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
#[must_use = "it may say that the atlas is not injective"]
pub struct AtlasCheck {
    /// The verdict.
    pub certificate: AtlasCertificate,
    /// Faces of triangles that overlap; those of polygons may come several times.
    pub pairs: Vec<[usize; 2]>,
}

/// Judges the UVs of the corners of a surface, from anywhere, as they are stored.
///
/// Charts are the triangles joined by edges with the same UVs on both sides. Triangles without area
/// on the surface are not judged, and triangles that disagree in orientation with their chart are
/// turned over, for a winding that changes is no fold.
///
/// ```
/// use beltrami::Surface;
///
/// let positions = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
/// let faces = [[0_u32, 1, 2], [0, 2, 3]];
/// // Two charts, one on top of the other.
/// let uvs = [[0.0_f32, 0.0], [1.0, 0.0], [1.0, 1.0], [0.1, 0.0], [1.1, 0.0], [1.1, 1.0]];
/// let surface = Surface::new(&positions, &faces).corner_uvs(&uvs);
/// let certificate = beltrami::check_atlas(&surface)?;
/// assert_eq!((certificate.injective, certificate.overlaps), (false, 1));
/// # Ok::<(), beltrami::Error>(())
/// ```
///
/// # Errors
///
/// [`InvalidArgument`](crate::ErrorKind::InvalidArgument) without [`Surface::corner_uvs`], and where lengths
/// do not fit together; [`Empty`](crate::ErrorKind::Empty),
/// [`IndexOutOfRange`](crate::ErrorKind::IndexOutOfRange), [`NonFinite`](crate::ErrorKind::NonFinite), with the
/// element that is the cause; [`OutOfMemory`](crate::ErrorKind::OutOfMemory).
pub fn check_atlas(surface: &Surface<'_>) -> Result<AtlasCertificate, Error> {
    Ok(check_atlas_with(surface, &AtlasRules::new(), &CancelToken::new())?.certificate)
}

/// [`check_atlas`] by rules of the caller's, that `token` ends.
///
/// # Errors
///
/// As of [`check_atlas`], and [`Cancelled`](crate::ErrorKind::Cancelled).
pub fn check_atlas_with(
    surface: &Surface<'_>,
    rules: &AtlasRules,
    token: &CancelToken,
) -> Result<AtlasCheck, Error> {
    let mut certificate = AtlasCertificate::raw();
    let mut pairs = vec![[sys::BELTRAMI_NO_ELEMENT; 2]; rules.most_pairs];
    let view = surface.raw(token)?;
    // SAFETY: the views are borrowed, all their items are there, as many as `view` says; the
    // certificate has the size that it says; there is room for as many pairs as is said.
    let status = unsafe {
        sys::beltrami_check_atlas(
            &view,
            i32::from(rules.allow_mirrored),
            &mut certificate,
            pairs.as_mut_ptr().cast(),
            pairs.len() as u64,
        )
    };
    if status < 0 {
        let place = Element::new(certificate.error_element_kind, certificate.error_element);
        return Err(Error::from_status(status, place));
    }
    let listed =
        pairs.iter().map_while(|&[first, second]| Some([element(first)?, element(second)?]));
    Ok(AtlasCheck { certificate: AtlasCertificate::new(&certificate), pairs: listed.collect() })
}

/// The triangles of polygons.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Triangulation<T> {
    /// Three corners each, n - 2 triangles for a face of n corners, those of one face after another.
    pub triangles: Vec<[T; 3]>,
    /// The first face that names a vertex twice, or that cannot be cut without repeating an edge.
    pub first_repeating: Option<usize>,
}

/// Cuts polygons into triangles as an [`Unwrapper`](crate::Unwrapper) does: by ears, the best-shaped
/// first.
///
/// ```
/// use beltrami::Surface;
///
/// // A chevron: the diagonal between its tips lies outside.
/// let positions = [[0.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.0, 2.0, 0.0], [1.0, 1.0, 0.0_f64]];
/// let surface = Surface::polygons(&positions, &[4_u32], &[0_u32, 1, 2, 3]);
/// let triangles = beltrami::triangulate::<u32>(&surface)?.triangles;
/// assert!(triangles.iter().all(|corners| corners.contains(&1) && corners.contains(&3)));
/// # Ok::<(), beltrami::Error>(())
/// ```
///
/// # Errors
///
/// [`InvalidArgument`](crate::ErrorKind::InvalidArgument) for a face of less than three corners,
/// [`Empty`](crate::ErrorKind::Empty), [`IndexOutOfRange`](crate::ErrorKind::IndexOutOfRange),
/// [`OutOfMemory`](crate::ErrorKind::OutOfMemory).
pub fn triangulate<T: WideIndex>(surface: &Surface<'_>) -> Result<Triangulation<T>, Error> {
    let token = CancelToken::new();
    let view = surface.raw(&token)?;
    let mut triangles = vec![[T::default(); 3]; surface.triangle_count()];
    let mut repeating = sys::BELTRAMI_NO_ELEMENT;
    let out = triangles.as_mut_ptr().cast();
    // SAFETY: the views are borrowed, all their items are there, as many as `view` says; there is
    // room for n - 2 triangles of this type for every face of n corners, and the library refuses
    // faces of less than 3 before it writes.
    let status = unsafe { sys::beltrami_triangulate(&view, out, T::TYPE, 0, &mut repeating) };
    if status < 0 {
        return Err(Error::from_status(status, None));
    }
    Ok(Triangulation { triangles, first_repeating: element(repeating) })
}
