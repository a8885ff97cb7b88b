//! Checks and measures of any UVs, whoever made them.

use std::mem::size_of;

use beltrami_sys as sys;

use crate::control::CancelToken;
use crate::error::{Element, Error};
use crate::mesh::{topology, Faces, Mesh, Uvs};
use crate::verdict::{Certificate, Crossings, Distortion, Orientations};

/// Distortion of the map of one face. All four are NaN where the face has no 3D area.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(C)]
pub struct FaceDistortion {
    /// The greater singular value: 1 is an isometry.
    pub s1: f64,
    /// The smaller singular value, `|s2| <= s1`; negative where the face is flipped.
    pub s2: f64,
    /// 1/2 (s1² + s2² + s1⁻² + s2⁻²), at least 2; infinite where the face is flipped or degenerate.
    pub symmetric_dirichlet: f64,
    /// (s1 - 1)² + (1/s2 - 1)², at least 0; infinite where the face is flipped or degenerate.
    pub symmetric_arap: f64,
}

type Check = unsafe extern "C" fn(
    *const sys::beltrami_mesh,
    *const sys::beltrami_buffer,
    *mut sys::beltrami_certificate,
) -> sys::beltrami_status;

/// Judges UVs, one per vertex, by one of the library's checks.
fn judge(
    check: Check,
    faces: Faces<'_>,
    uvs: Uvs<'_>,
    token: &CancelToken,
) -> Result<Certificate, Error> {
    let mesh = sys::beltrami_mesh { cancel: token.number(), ..topology(faces, uvs.len()) };
    let mut raw = Certificate::raw();
    // SAFETY: the views are borrowed, all their items are there; `raw` has the size that it says.
    let status = unsafe { check(&mesh, &uvs.0.raw(), &mut raw) };
    if status < 0 {
        return Err(Error::from_status(
            status,
            Element::new(raw.error_element_kind, raw.error_element),
        ));
    }
    Ok(Certificate::new(&raw))
}

/// Judges whether the map with these UVs, one per vertex, is injective.
///
/// They are judged as they are stored: give the very array that goes into the asset, since rounding
/// to single precision can flip a sliver.
///
/// ```
/// let faces = [[0_u32, 1, 2], [0, 2, 3]];
/// let square = [[0.0_f32, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
/// assert!(beltrami::check_injective(&faces, &square)?.injective);
///
/// let folded = [[0.0_f32, 0.0], [1.0, 0.0], [1.0, 1.0], [0.75, 0.25]];
/// let certificate = beltrami::check_injective(&faces, &folded)?;
/// assert_eq!(certificate.orientations.first_bad_face, Some(1));
/// # Ok::<(), beltrami::Error>(())
/// ```
///
/// # Errors
///
/// [`NonFinite`](crate::ErrorKind::NonFinite) for a UV, and the kinds of a mesh that is not one
/// oriented disk, with the element that is the cause; [`OutOfMemory`](crate::ErrorKind::OutOfMemory).
pub fn check_injective<'a>(
    faces: impl Into<Faces<'a>>,
    uvs: impl Into<Uvs<'a>>,
) -> Result<Certificate, Error> {
    check_injective_with(faces, uvs, &CancelToken::new())
}

/// [`check_injective`] that `token` ends.
///
/// # Errors
///
/// As of [`check_injective`], and [`Cancelled`](crate::ErrorKind::Cancelled).
pub fn check_injective_with<'a>(
    faces: impl Into<Faces<'a>>,
    uvs: impl Into<Uvs<'a>>,
    token: &CancelToken,
) -> Result<Certificate, Error> {
    judge(sys::beltrami_check_injective, faces.into(), uvs.into(), token)
}

/// Judges the orientation of every face. Any list of triangles will do: it needs no topology.
///
/// # Errors
///
/// [`IndexOutOfRange`](crate::ErrorKind::IndexOutOfRange),
/// [`NonFinite`](crate::ErrorKind::NonFinite) for a UV, [`Empty`](crate::ErrorKind::Empty),
/// [`OutOfMemory`](crate::ErrorKind::OutOfMemory).
pub fn check_triangles<'a>(
    faces: impl Into<Faces<'a>>,
    uvs: impl Into<Uvs<'a>>,
) -> Result<Orientations, Error> {
    check_triangles_with(faces, uvs, &CancelToken::new())
}

/// [`check_triangles`] that `token` ends.
///
/// # Errors
///
/// As of [`check_triangles`], and [`Cancelled`](crate::ErrorKind::Cancelled).
pub fn check_triangles_with<'a>(
    faces: impl Into<Faces<'a>>,
    uvs: impl Into<Uvs<'a>>,
    token: &CancelToken,
) -> Result<Orientations, Error> {
    Ok(judge(sys::beltrami_check_triangles, faces.into(), uvs.into(), token)?.orientations)
}

/// Judges whether the boundary loop is simple, and verifies that the faces form one oriented disk.
///
/// # Errors
///
/// As of [`check_injective`].
pub fn check_boundary<'a>(
    faces: impl Into<Faces<'a>>,
    uvs: impl Into<Uvs<'a>>,
) -> Result<Crossings, Error> {
    check_boundary_with(faces, uvs, &CancelToken::new())
}

/// [`check_boundary`] that `token` ends.
///
/// # Errors
///
/// As of [`check_boundary`], and [`Cancelled`](crate::ErrorKind::Cancelled).
pub fn check_boundary_with<'a>(
    faces: impl Into<Faces<'a>>,
    uvs: impl Into<Uvs<'a>>,
    token: &CancelToken,
) -> Result<Crossings, Error> {
    Ok(judge(sys::beltrami_check_boundary, faces.into(), uvs.into(), token)?.crossings)
}

/// Why a measure failed, with the element where it is one of the faces or the UVs. A measure does not
/// name it, but the check that reads the same does.
fn measure_failure(
    status: sys::beltrami_status,
    mesh: &Mesh<'_>,
    uvs: Uvs<'_>,
    token: &CancelToken,
) -> Error {
    match judge(sys::beltrami_check_triangles, mesh.faces, uvs, token) {
        Err(error) if error.kind.status() == status => error,
        _ => Error::from_status(status, None),
    }
}

/// Distortion of any UVs, one per vertex, in the unit of length of the positions.
///
/// # Errors
///
/// [`InvalidArgument`](crate::ErrorKind::InvalidArgument) unless there is one UV per vertex,
/// [`IndexOutOfRange`](crate::ErrorKind::IndexOutOfRange) with the face,
/// [`NonFinite`](crate::ErrorKind::NonFinite) with the vertex where it is a UV, [`Empty`](crate::ErrorKind::Empty),
/// [`OutOfMemory`](crate::ErrorKind::OutOfMemory).
pub fn measure<'a>(mesh: &Mesh<'_>, uvs: impl Into<Uvs<'a>>) -> Result<Distortion, Error> {
    measure_with(mesh, uvs, &CancelToken::new())
}

/// [`measure`] that `token` ends.
///
/// # Errors
///
/// As of [`measure`], and [`Cancelled`](crate::ErrorKind::Cancelled).
pub fn measure_with<'a>(
    mesh: &Mesh<'_>,
    uvs: impl Into<Uvs<'a>>,
    token: &CancelToken,
) -> Result<Distortion, Error> {
    let uvs = uvs.into();
    mesh.require_one_uv_per_vertex(&uvs)?;
    let mut raw = Distortion::raw();
    let view = sys::beltrami_mesh { cancel: token.number(), ..mesh.raw() };
    // SAFETY: the views are borrowed, all their items are there; `raw` has the size that it says;
    // no energies of faces are asked for.
    let status =
        unsafe { sys::beltrami_measure(&view, &uvs.0.raw(), &mut raw, std::ptr::null_mut()) };
    if status < 0 {
        return Err(measure_failure(status, mesh, uvs, token));
    }
    Ok(Distortion::new(&raw))
}

/// Distortion of every face of any UVs, one per vertex, in the unit of length of the positions. It
/// needs no topology.
///
/// # Errors
///
/// As of [`measure`].
pub fn measure_faces<'a>(
    mesh: &Mesh<'_>,
    uvs: impl Into<Uvs<'a>>,
) -> Result<Vec<FaceDistortion>, Error> {
    measure_faces_with(mesh, uvs, &CancelToken::new())
}

/// [`measure_faces`] that `token` ends.
///
/// # Errors
///
/// As of [`measure_faces`], and [`Cancelled`](crate::ErrorKind::Cancelled).
pub fn measure_faces_with<'a>(
    mesh: &Mesh<'_>,
    uvs: impl Into<Uvs<'a>>,
    token: &CancelToken,
) -> Result<Vec<FaceDistortion>, Error> {
    let uvs = uvs.into();
    mesh.require_one_uv_per_vertex(&uvs)?;
    let mut faces = vec![FaceDistortion::default(); mesh.faces.len()];
    let view = sys::beltrami_mesh { cancel: token.number(), ..mesh.raw() };
    // SAFETY: the views are borrowed, all their items are there; a FaceDistortion is the four
    // numbers that the library writes per face.
    let status = unsafe {
        sys::beltrami_measure_faces(
            &view,
            &uvs.0.raw(),
            faces.as_mut_ptr().cast(),
            size_of::<FaceDistortion>() as u64,
        )
    };
    if status < 0 {
        return Err(measure_failure(status, mesh, uvs, token));
    }
    Ok(faces)
}
