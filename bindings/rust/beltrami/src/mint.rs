//! Vectors and points of mint as positions and UVs: borrowed as they are, and handed out.

use mint::{Point2, Point3, Vector2, Vector3};

use crate::mesh::{private, Positions, Uv, Uvs, UvsMut};
use crate::view::{View, ViewMut};

/// Why from_field cannot fail here.
const SAME_PART: &str = "the components are the same part of every vector";

macro_rules! input {
    ($( $vector:ty => $target:ident; )*) => { $(
        impl<'a> From<&'a [$vector]> for $target<'a> {
            fn from(items: &'a [$vector]) -> Self {
                View::from_field(items, |item| item.as_ref()).expect(SAME_PART).into()
            }
        }
        impl<'a> From<&'a Vec<$vector>> for $target<'a> {
            fn from(items: &'a Vec<$vector>) -> Self {
                items.as_slice().into()
            }
        }
        impl<'a, const LEN: usize> From<&'a [$vector; LEN]> for $target<'a> {
            fn from(items: &'a [$vector; LEN]) -> Self {
                items.as_slice().into()
            }
        }
    )* };
}
input! {
    Vector3<f32> => Positions;
    Vector3<f64> => Positions;
    Point3<f32> => Positions;
    Point3<f64> => Positions;
    Vector2<f32> => Uvs;
    Vector2<f64> => Uvs;
    Point2<f32> => Uvs;
    Point2<f64> => Uvs;
}

macro_rules! output {
    ($( $vector:ty ),*) => { $(
        impl<'a> From<&'a mut [$vector]> for UvsMut<'a> {
            fn from(items: &'a mut [$vector]) -> Self {
                ViewMut::from_field(items, |item| item.as_mut()).expect(SAME_PART).into()
            }
        }
        impl<'a> From<&'a mut Vec<$vector>> for UvsMut<'a> {
            fn from(items: &'a mut Vec<$vector>) -> Self {
                items.as_mut_slice().into()
            }
        }
        impl private::Sealed for $vector {}
        impl Uv for $vector {
            fn origin() -> Self {
                [0.0, 0.0].into()
            }

            fn room(uvs: &mut [Self]) -> UvsMut<'_> {
                uvs.into()
            }
        }
    )* };
}
output!(Vector2<f32>, Vector2<f64>, Point2<f32>, Point2<f64>);
