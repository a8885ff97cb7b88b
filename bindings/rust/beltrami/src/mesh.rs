//! What goes into the library and comes out of it: positions, faces and UVs, as views.

use std::mem::size_of;

use beltrami_sys as sys;

use crate::error::Error;
use crate::view::{Buffer, BufferMut, Index, Real, View, ViewMut};

/// One position (x, y, z) per vertex, borrowed, in any unit of length.
///
/// Converts from `&[[f32; 3]]`, `&[[f64; 3]]`, references to arrays and `Vec`s of these, and from
/// [`View`]s of either; with the features `mint` and `ndarray` from their types.
#[derive(Clone, Copy)]
pub struct Positions<'a>(pub(crate) Buffer<'a>);

/// Three vertices per face, counter-clockwise, borrowed.
///
/// Converts from `&[[u16; 3]]`, `&[[u32; 3]]`, `&[[u64; 3]]`, references to arrays and `Vec`s of
/// these, and from [`View`]s of either; with the feature `ndarray` from its views.
#[derive(Clone, Copy)]
pub struct Faces<'a>(pub(crate) Buffer<'a>);

/// One (u, v) per vertex, borrowed.
///
/// Converts from `&[[f32; 2]]`, `&[[f64; 2]]`, references to arrays and `Vec`s of these, and from
/// [`View`]s of either; with the features `mint` and `ndarray` from their types.
#[derive(Clone, Copy)]
pub struct Uvs<'a>(pub(crate) Buffer<'a>);

/// Room for one (u, v) per vertex, borrowed.
///
/// Converts from what [`Uvs`] does, in its mutable form.
pub struct UvsMut<'a>(pub(crate) BufferMut<'a>);

/// The conversions to a type of views, from views, slices, arrays and `Vec`s.
macro_rules! conversions {
    ($target:ident, $scalar:ident, $n:literal) => {
        impl<'a, T: $scalar> From<View<'a, T, $n>> for $target<'a> {
            fn from(view: View<'a, T, $n>) -> Self {
                $target(view.erase())
            }
        }
        impl<'a, T: $scalar> From<&'a [[T; $n]]> for $target<'a> {
            fn from(items: &'a [[T; $n]]) -> Self {
                View::from(items).into()
            }
        }
        impl<'a, T: $scalar> From<&'a Vec<[T; $n]>> for $target<'a> {
            fn from(items: &'a Vec<[T; $n]>) -> Self {
                items.as_slice().into()
            }
        }
        impl<'a, T: $scalar, const LEN: usize> From<&'a [[T; $n]; LEN]> for $target<'a> {
            fn from(items: &'a [[T; $n]; LEN]) -> Self {
                items.as_slice().into()
            }
        }
        impl $target<'_> {
            /// Number of items.
            pub fn len(&self) -> usize {
                self.0.len
            }

            /// Whether there are no items.
            pub fn is_empty(&self) -> bool {
                self.0.len == 0
            }
        }
        impl std::fmt::Debug for $target<'_> {
            fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                formatter.debug_struct(stringify!($target)).field("len", &self.len()).finish()
            }
        }
    };
}
conversions!(Positions, Real, 3);
conversions!(Faces, Index, 3);
conversions!(Uvs, Real, 2);

impl<'a, T: Real> From<ViewMut<'a, T, 2>> for UvsMut<'a> {
    fn from(view: ViewMut<'a, T, 2>) -> Self {
        UvsMut(view.erase())
    }
}

impl<'a, T: Real> From<&'a mut [[T; 2]]> for UvsMut<'a> {
    fn from(items: &'a mut [[T; 2]]) -> Self {
        ViewMut::from(items).into()
    }
}

impl<'a, T: Real> From<&'a mut Vec<[T; 2]>> for UvsMut<'a> {
    fn from(items: &'a mut Vec<[T; 2]>) -> Self {
        items.as_mut_slice().into()
    }
}

impl<'a, T: Real, const LEN: usize> From<&'a mut [[T; 2]; LEN]> for UvsMut<'a> {
    fn from(items: &'a mut [[T; 2]; LEN]) -> Self {
        items.as_mut_slice().into()
    }
}

impl UvsMut<'_> {
    /// Number of items.
    pub fn len(&self) -> usize {
        self.0.len
    }

    /// Whether there are no items.
    pub fn is_empty(&self) -> bool {
        self.0.len == 0
    }
}

impl std::fmt::Debug for UvsMut<'_> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("UvsMut").field("len", &self.len()).finish()
    }
}

/// A (u, v) of its own: `[f32; 2]`, `[f64; 2]`, with the feature `mint` its vectors and points of two.
pub trait Uv: Copy + private::Sealed {
    /// (0, 0).
    fn origin() -> Self;

    /// Room for UVs of this type.
    fn room(uvs: &mut [Self]) -> UvsMut<'_>;
}

impl<T: Real> Uv for [T; 2]
where
    [T; 2]: Default,
{
    fn origin() -> Self {
        Self::default()
    }

    fn room(uvs: &mut [Self]) -> UvsMut<'_> {
        uvs.into()
    }
}

pub(crate) mod private {
    /// Keeps [`Uv`](super::Uv) to the types that this crate knows.
    #[allow(unknown_lints, unnameable_types)] // so that nobody implements it
    pub trait Sealed {}
    impl<T: crate::view::Real> Sealed for [T; 2] {}
}

/// A triangle mesh in the caller's memory.
///
/// To be flattened, its faces must form one consistently oriented disk: one component, edge- and
/// vertex-manifold, one boundary loop, no handles. Vertices that no face uses are allowed, and get
/// the UV (0, 0).
///
/// ```
/// # use beltrami::{Flattener, Mesh};
/// let positions = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 1.0], [0.0, 1.0, 0.0]];
/// let faces = [[0_u32, 1, 2], [0, 2, 3]];
/// let mesh = Mesh::new(&positions, &faces);
/// # assert_eq!((mesh.positions.len(), mesh.faces.len()), (4, 2));
/// ```
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct Mesh<'a> {
    /// One position per vertex.
    pub positions: Positions<'a>,
    /// Three vertices per face.
    pub faces: Faces<'a>,
}

impl<'a> Mesh<'a> {
    /// Borrows both; nothing is looked at yet.
    pub fn new(positions: impl Into<Positions<'a>>, faces: impl Into<Faces<'a>>) -> Mesh<'a> {
        Mesh { positions: positions.into(), faces: faces.into() }
    }

    /// The library's description, valid for as long as the borrow lasts.
    pub(crate) fn raw(&self) -> sys::beltrami_mesh {
        sys::beltrami_mesh {
            positions: self.positions.0.raw(),
            ..topology(self.faces, self.positions.len())
        }
    }

    /// Fails unless there is one UV per vertex.
    pub(crate) fn require_one_uv_per_vertex(&self, uvs: &Uvs<'_>) -> Result<(), Error> {
        if uvs.len() == self.positions.len() {
            return Ok(());
        }
        Err(Error::argument(format!(
            "there are {} UVs for {} vertices: give one per vertex",
            uvs.len(),
            self.positions.len()
        )))
    }
}

/// The library's description of faces without positions.
pub(crate) fn topology(faces: Faces<'_>, vertices: usize) -> sys::beltrami_mesh {
    sys::beltrami_mesh {
        struct_size: size_of::<sys::beltrami_mesh>() as u32,
        vertex_count: vertices as u64,
        face_count: faces.len() as u64,
        indices: faces.0.raw(),
        ..Default::default()
    }
}
