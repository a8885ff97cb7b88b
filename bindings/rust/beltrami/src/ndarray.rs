//! Arrays of ndarray as positions, faces and UVs: borrowed as they are, and handed out.

use std::mem::size_of;

use ndarray::{Array2, ArrayView2};

use crate::atlas::Atlas;
use crate::error::Error;
use crate::mesh::{Faces, Positions, Uvs};
use crate::parameterization::Parameterization;
use crate::view::{Index, Real, Scalar, View, ViewMut};

/// The rows of an array, as they lie.
fn rows<'a, T: Scalar, const N: usize>(array: &ArrayView2<'a, T>) -> Result<View<'a, T, N>, Error> {
    let (rows, columns) = array.dim();
    if columns != N {
        return Err(Error::argument(format!("the array has {columns} columns: give {N}")));
    }
    if rows == 0 {
        return View::from_flat(&[]);
    }
    let &[row_stride, column_stride] = array.strides() else { unreachable!("it has two axes") };
    let row_stride = if rows == 1 { N } else { usize::try_from(row_stride).unwrap_or(0) };
    if column_stride != 1 || row_stride < N {
        return Err(Error::argument(
            "the rows of the array are not contiguous, one after the other: \
             give its as_standard_layout()",
        ));
    }
    // SAFETY: the array is borrowed for 'a and has `rows` rows, `row_stride` numbers apart; each is
    // N numbers that follow each other.
    Ok(unsafe { View::new(array.as_ptr(), row_stride * size_of::<T>(), rows) })
}

macro_rules! input {
    ($( $target:ident, $scalar:ident; )*) => { $(
        /// Of any array whose rows are contiguous: standard layout, or columns sliced from it.
        impl<'a, T: $scalar> TryFrom<ArrayView2<'a, T>> for $target<'a> {
            type Error = Error;

            fn try_from(array: ArrayView2<'a, T>) -> Result<Self, Error> {
                rows(&array).map(Self::from)
            }
        }
    )* };
}
input! {
    Positions, Real;
    Faces, Index;
    Uvs, Real;
}

/// An array of `rows` UVs that `write` fills.
fn uvs_array<T: Real + ndarray::LinalgScalar>(
    rows: usize,
    write: impl FnOnce(ViewMut<'_, T, 2>) -> Result<(), Error>,
) -> Array2<T> {
    let mut uvs = Array2::zeros((rows, 2));
    let numbers = uvs.as_slice_mut().expect("a new array is in standard layout");
    let room = ViewMut::from_flat(numbers).expect("two numbers per row");
    write(room).expect("as many rows as UVs");
    uvs
}

impl Parameterization<'_> {
    /// What [`uvs`](Self::uvs) returns, as an array with a row (u, v) for every vertex.
    pub fn uvs_array<T: Real + ndarray::LinalgScalar>(&self) -> Array2<T> {
        uvs_array(self.summary().vertices, |room| self.write_uvs(room))
    }
}

impl Atlas<'_> {
    /// What [`uvs`](Self::uvs) returns, as an array with a row (u, v) for every UV vertex.
    pub fn uvs_array<T: Real + ndarray::LinalgScalar>(&self) -> Array2<T> {
        uvs_array(self.summary().uv_vertices, |room| self.write_uvs(room))
    }

    /// What [`corner_uvs`](Self::corner_uvs) returns, as an array with a row (u, v) for every
    /// corner.
    pub fn corner_uvs_array<T: Real + ndarray::LinalgScalar>(&self) -> Array2<T> {
        uvs_array(self.summary().corners, |room| self.write_corner_uvs(room))
    }
}
