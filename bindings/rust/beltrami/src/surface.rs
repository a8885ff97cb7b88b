//! Polygons of any kind, with what says where they are cut.

use std::mem::size_of;

use beltrami_sys as sys;

use crate::control::CancelToken;
use crate::error::Error;
use crate::mesh::{Faces, Positions, Uvs};
use crate::view::{Buffer, Index, Real, View};

/// Defines a borrowed list of lone numbers.
macro_rules! numbers {
    ($(#[$doc:meta])* $target:ident, $scalar:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy)]
        pub struct $target<'a>(pub(crate) Buffer<'a>);

        impl<'a, T: $scalar> From<View<'a, T, 1>> for $target<'a> {
            fn from(view: View<'a, T, 1>) -> Self {
                $target(view.erase())
            }
        }
        impl<'a, T: $scalar> From<&'a [T]> for $target<'a> {
            fn from(numbers: &'a [T]) -> Self {
                View::<T, 1>::from_flat(numbers).expect("any number of numbers").into()
            }
        }
        impl<'a, T: $scalar> From<&'a Vec<T>> for $target<'a> {
            fn from(numbers: &'a Vec<T>) -> Self {
                numbers.as_slice().into()
            }
        }
        impl<'a, T: $scalar, const LEN: usize> From<&'a [T; LEN]> for $target<'a> {
            fn from(numbers: &'a [T; LEN]) -> Self {
                numbers.as_slice().into()
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

numbers! {
    /// Whole numbers, borrowed: vertices of corners, sizes or labels of faces.
    ///
    /// Converts from `&[u16]`, `&[u32]`, `&[u64]`, references to arrays and `Vec`s of these, and
    /// from [`View`]s of one number.
    Integers, Index
}
numbers! {
    /// Real numbers, borrowed: densities of faces.
    ///
    /// Converts from `&[f32]`, `&[f64]`, references to arrays and `Vec`s of these, and from
    /// [`View`]s of one number.
    Reals, Real
}

macro_rules! tuples {
    ($(#[$doc:meta])* $name:ident, $size:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy)]
        pub struct $name<'a>(pub(crate) Buffer<'a>);

        impl<'a, T: Index> From<View<'a, T, $size>> for $name<'a> {
            fn from(view: View<'a, T, $size>) -> Self {
                $name(view.erase())
            }
        }

        impl<'a, T: Index> From<&'a [[T; $size]]> for $name<'a> {
            fn from(items: &'a [[T; $size]]) -> Self {
                View::from(items).into()
            }
        }

        impl<'a, T: Index> From<&'a Vec<[T; $size]>> for $name<'a> {
            fn from(items: &'a Vec<[T; $size]>) -> Self {
                items.as_slice().into()
            }
        }

        impl<'a, T: Index, const LEN: usize> From<&'a [[T; $size]; LEN]> for $name<'a> {
            fn from(items: &'a [[T; $size]; LEN]) -> Self {
                items.as_slice().into()
            }
        }

        impl std::fmt::Debug for $name<'_> {
            fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                formatter.debug_struct(stringify!($name)).field("len", &self.0.len).finish()
            }
        }
    };
}
tuples! {
    /// Pairs of vertices, borrowed: edges.
    ///
    /// Converts from `&[[u16; 2]]`, `&[[u32; 2]]`, `&[[u64; 2]]`, references to arrays and
    /// `Vec`s of these, and from [`View`]s of either.
    Edges, 2
}
tuples! {
    /// Four vertices each, borrowed: corners of rectangles.
    ///
    /// Converts from `&[[u16; 4]]`, `&[[u32; 4]]`, `&[[u64; 4]]`, references to arrays and
    /// `Vec`s of these, and from [`View`]s of either.
    Quadruples, 4
}

/// What is held of a pin, and what edges that are straight have in common.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u32)]
#[non_exhaustive]
pub enum PinKind {
    /// Both coordinates.
    Point = sys::BELTRAMI_PIN_POINT as u32,
    /// u: it may slide along v.
    U = sys::BELTRAMI_PIN_U as u32,
    /// v: it may slide along u.
    V = sys::BELTRAMI_PIN_V as u32,
    /// That it lies on a line, along which it may slide.
    Line = sys::BELTRAMI_PIN_LINE as u32,
}

/// The corners of the faces.
#[derive(Debug, Clone, Copy)]
enum Corners<'a> {
    Triangles(Faces<'a>),
    Polygons { sizes: Integers<'a>, vertices: Integers<'a> },
}

/// Faces of three or more corners in the caller's memory: any number of components, with holes and
/// handles or without, closed or open, of any quality.
///
/// A corner is one vertex of one face; corners are counted from 0, face after face.
///
/// ```
/// use beltrami::Surface;
///
/// let positions = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0],
///                  [0.5, 0.5, 1.0]];
/// // A square and four triangles: a pyramid.
/// let sizes = [4_u32, 3, 3, 3, 3];
/// let corners = [3_u32, 2, 1, 0, 0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4];
/// let labels = [0_u32, 1, 1, 1, 1];
/// let surface = Surface::polygons(&positions, &sizes, &corners).face_labels(&labels);
/// # assert_eq!((surface.face_count(), surface.corner_count()), (5, 16));
/// ```
#[derive(Debug, Clone, Copy)]
#[must_use = "give it to an Unwrapper"]
pub struct Surface<'a> {
    positions: Positions<'a>,
    corners: Corners<'a>,
    corner_uvs: Option<Uvs<'a>>,
    face_labels: Option<Integers<'a>>,
    densities: Option<Reals<'a>>,
    seams: Option<Edges<'a>>,
    pins: Option<(Integers<'a>, Uvs<'a>)>,
    pin_kinds: Option<(Integers<'a>, Uvs<'a>)>,
    straight_edges: Option<(Edges<'a>, Integers<'a>)>,
    rectangles: Option<Integers<'a>>,
    rectangle_corners: Option<Quadruples<'a>>,
    vertex_paint: Option<Reals<'a>>,
    edge_paint: Option<(Edges<'a>, Reals<'a>)>,
    materials: Option<Integers<'a>>,
}

impl<'a> Surface<'a> {
    /// Triangles: one position per vertex, three vertices per face. Nothing is looked at yet.
    pub fn new(positions: impl Into<Positions<'a>>, faces: impl Into<Faces<'a>>) -> Surface<'a> {
        Surface::with(positions.into(), Corners::Triangles(faces.into()))
    }

    /// Polygons: for each face how many corners it has, 3 or more, and for each corner its vertex,
    /// face after face. Nothing is looked at yet.
    pub fn polygons(
        positions: impl Into<Positions<'a>>,
        sizes: impl Into<Integers<'a>>,
        corners: impl Into<Integers<'a>>,
    ) -> Surface<'a> {
        let corners = Corners::Polygons { sizes: sizes.into(), vertices: corners.into() };
        Surface::with(positions.into(), corners)
    }

    fn with(positions: Positions<'a>, corners: Corners<'a>) -> Surface<'a> {
        Surface {
            positions,
            corners,
            corner_uvs: None,
            face_labels: None,
            densities: None,
            seams: None,
            pins: None,
            pin_kinds: None,
            straight_edges: None,
            rectangles: None,
            rectangle_corners: None,
            vertex_paint: None,
            edge_paint: None,
            materials: None,
        }
    }

    /// UVs, one for each corner: with [`Cut::Islands`](crate::Cut::Islands) seams run where they
    /// part, and [`check_atlas`](crate::check_atlas) judges them.
    pub fn corner_uvs(mut self, uvs: impl Into<Uvs<'a>>) -> Self {
        self.corner_uvs = Some(uvs.into());
        self
    }

    /// A number for each face, a material or a group: seams run where they differ.
    pub fn face_labels(mut self, labels: impl Into<Integers<'a>>) -> Self {
        self.face_labels = Some(labels.into());
        self
    }

    /// A number above 0 for each face: how much larger it is to be in the plane. A chart has the
    /// mean.
    pub fn densities(mut self, densities: impl Into<Reals<'a>>) -> Self {
        self.densities = Some(densities.into());
        self
    }

    /// Edges to cut; pairs that are no edge are ignored.
    pub fn seams(mut self, seams: impl Into<Edges<'a>>) -> Self {
        self.seams = Some(seams.into());
        self
    }

    /// Corners to hold, counted from 0 face after face, and the UVs that they get, to the bit: a
    /// chart takes the scale of its pins. Unwrapping fails with
    /// [`ErrorKind::Pins`](crate::ErrorKind::Pins), and the corner, where no injective map meets
    /// them, and with [`ErrorKind::InvalidArgument`](crate::ErrorKind::InvalidArgument) where there
    /// are not as many UVs as corners.
    pub fn pins(mut self, corners: impl Into<Integers<'a>>, uvs: impl Into<Uvs<'a>>) -> Self {
        self.pins = Some((corners.into(), uvs.into()));
        self
    }

    /// What is held of each pin, a [`PinKind`] as an integer, and a direction for each, which says
    /// something of [`PinKind::Line`] alone. Unwrapping fails with
    /// [`ErrorKind::InvalidArgument`](crate::ErrorKind::InvalidArgument) where there are not as many
    /// as pins.
    pub fn pin_kinds(
        mut self,
        kinds: impl Into<Integers<'a>>,
        directions: impl Into<Uvs<'a>>,
    ) -> Self {
        self.pin_kinds = Some((kinds.into(), directions.into()));
        self
    }

    /// Edges, by their vertices, that become straight with those of their kind that they meet, in
    /// each chart that has them. For each there is a [`PinKind`] as an integer, but not
    /// [`PinKind::Point`]. Unwrapping fails with [`ErrorKind::Pins`](crate::ErrorKind::Pins) where
    /// no injective map has them straight.
    pub fn straight_edges(
        mut self,
        edges: impl Into<Edges<'a>>,
        kinds: impl Into<Integers<'a>>,
    ) -> Self {
        self.straight_edges = Some((edges.into(), kinds.into()));
        self
    }

    /// Faces whose charts become rectangles along the axes: grids of quads where they are rows and
    /// columns of these, else with the four corners that their borders have. Unwrapping fails with
    /// [`ErrorKind::Pins`](crate::ErrorKind::Pins), and the face, where it has none.
    pub fn rectangles(mut self, faces: impl Into<Integers<'a>>) -> Self {
        self.rectangles = Some(faces.into());
        self
    }

    /// Four vertices of the border of each rectangle, its corners.
    pub fn rectangle_corners(mut self, corners: impl Into<Quadruples<'a>>) -> Self {
        self.rectangle_corners = Some(corners.into());
        self
    }

    /// A factor for each vertex of what a seam costs there, with [`Cut::Auto`](crate::Cut::Auto):
    /// finite and at least 0, less than 1 to draw seams. It counts from 0.05 to 20, and forces
    /// nothing; an edge has the geometric mean of its ends.
    pub fn vertex_paint(mut self, factors: impl Into<Reals<'a>>) -> Self {
        self.vertex_paint = Some(factors.into());
        self
    }

    /// Edges, by their vertices, and a factor for each that multiplies those of its ends; pairs
    /// that are no edge are ignored. Unwrapping fails with
    /// [`ErrorKind::InvalidArgument`](crate::ErrorKind::InvalidArgument) where there are not as many
    /// factors as edges.
    pub fn edge_paint(
        mut self,
        edges: impl Into<Edges<'a>>,
        factors: impl Into<Reals<'a>>,
    ) -> Self {
        self.edge_paint = Some((edges.into(), factors.into()));
        self
    }

    /// A number for each face: with [`Cut::Auto`](crate::Cut::Auto) seams are drawn to where they
    /// differ, and cost [`material_seams`](crate::UnwrapOptions::material_seams) of their length
    /// there.
    pub fn materials(mut self, materials: impl Into<Integers<'a>>) -> Self {
        self.materials = Some(materials.into());
        self
    }

    /// Number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.positions.len()
    }

    /// Number of faces.
    pub fn face_count(&self) -> usize {
        match self.corners {
            Corners::Triangles(faces) => faces.len(),
            Corners::Polygons { sizes, .. } => sizes.len(),
        }
    }

    /// Number of corners of all faces.
    pub fn corner_count(&self) -> usize {
        match self.corners {
            Corners::Triangles(faces) => 3 * faces.len(),
            Corners::Polygons { vertices, .. } => vertices.len(),
        }
    }

    /// Number of triangles that the faces are cut into, if none has less than three corners.
    pub(crate) fn triangle_count(&self) -> usize {
        self.corner_count().saturating_sub(2 * self.face_count())
    }

    /// The library's description, which holds as long as the borrow and the token. Fails with
    /// `InvalidArgument` where lengths do not fit together.
    pub(crate) fn raw(&self, token: &CancelToken) -> Result<sys::beltrami_surface, Error> {
        let (faces, corners) = (self.face_count(), self.corner_count());
        let require = |what: &str, given: Option<usize>, wanted: usize, each: &str| match given {
            Some(given) if given != wanted => Err(Error::argument(format!(
                "there are {given} {what} for {wanted} {each}s: give one per {each}"
            ))),
            _ => Ok(()),
        };
        require("corner UVs", self.corner_uvs.map(|uvs| uvs.len()), corners, "corner")?;
        require("face labels", self.face_labels.map(|labels| labels.len()), faces, "face")?;
        require("densities", self.densities.map(|densities| densities.len()), faces, "face")?;
        if let Some((pinned, uvs)) = &self.pins {
            require("UVs of pins", Some(uvs.len()), pinned.len(), "pin")?;
        }
        let pins = self.pins.map_or(0, |(corners, _)| corners.0.len);
        if let Some((kinds, directions)) = &self.pin_kinds {
            require("kinds of pins", Some(kinds.len()), pins, "pin")?;
            require("directions", Some(directions.len()), pins, "pin")?;
        }
        if let Some((edges, kinds)) = &self.straight_edges {
            require("kinds", Some(kinds.len()), edges.0.len, "straight edge")?;
        }
        let rectangles = self.rectangles.map_or(0, |faces| faces.len());
        let corners_of = self.rectangle_corners.map(|corners| corners.0.len);
        require("quadruples of corners", corners_of, rectangles, "rectangle")?;
        let vertices = self.vertex_count();
        require("factors", self.vertex_paint.map(|paint| paint.len()), vertices, "vertex")?;
        if let Some((edges, factors)) = &self.edge_paint {
            require("factors", Some(factors.len()), edges.0.len, "painted edge")?;
        }
        require("materials", self.materials.map(|materials| materials.len()), faces, "face")?;
        let (indices, face_sizes) = match self.corners {
            Corners::Triangles(faces) => (faces.0.raw(), sys::beltrami_buffer::default()),
            Corners::Polygons { sizes, vertices } => (vertices.0.raw(), sizes.0.raw()),
        };
        let optional =
            |buffer: Option<Buffer<'_>>| buffer.map_or_else(Default::default, |b| b.raw());
        Ok(sys::beltrami_surface {
            struct_size: size_of::<sys::beltrami_surface>() as u32,
            vertex_count: self.positions.len() as u64,
            face_count: faces as u64,
            corner_count: corners as u64,
            positions: self.positions.0.raw(),
            indices,
            face_sizes,
            corner_uvs: optional(self.corner_uvs.map(|uvs| uvs.0)),
            face_labels: optional(self.face_labels.map(|labels| labels.0)),
            densities: optional(self.densities.map(|densities| densities.0)),
            seams: optional(self.seams.map(|seams| seams.0)),
            seam_count: self.seams.map_or(0, |seams| seams.0.len as u64),
            pins: optional(self.pins.map(|(corners, _)| corners.0)),
            pin_uvs: optional(self.pins.map(|(_, uvs)| uvs.0)),
            pin_count: self.pins.map_or(0, |(corners, _)| corners.0.len as u64),
            pin_kinds: optional(self.pin_kinds.map(|(kinds, _)| kinds.0)),
            pin_directions: optional(self.pin_kinds.map(|(_, directions)| directions.0)),
            straight_edges: optional(self.straight_edges.map(|(edges, _)| edges.0)),
            straight_kinds: optional(self.straight_edges.map(|(_, kinds)| kinds.0)),
            straight_edge_count: self.straight_edges.map_or(0, |(edges, _)| edges.0.len as u64),
            rectangles: optional(self.rectangles.map(|faces| faces.0)),
            rectangle_corners: optional(self.rectangle_corners.map(|corners| corners.0)),
            rectangle_count: rectangles as u64,
            vertex_paint: optional(self.vertex_paint.map(|paint| paint.0)),
            painted_edges: optional(self.edge_paint.map(|(edges, _)| edges.0)),
            edge_paint: optional(self.edge_paint.map(|(_, factors)| factors.0)),
            painted_edge_count: self.edge_paint.map_or(0, |(edges, _)| edges.0.len as u64),
            materials: optional(self.materials.map(|materials| materials.0)),
            cancel: token.number(),
            ..Default::default()
        })
    }
}
