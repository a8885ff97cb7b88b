//! What the library has to say of UVs: whether they are injective, how much they distort.

use std::mem::size_of;

use beltrami_sys as sys;

use crate::error::Element;

/// Orientation of the faces of a map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
#[must_use = "it may say that faces are flipped"]
pub struct Orientations {
    /// Faces of positive area in UV.
    pub positive: usize,
    /// Faces of negative area: flipped.
    pub negative: usize,
    /// Faces of no area.
    pub degenerate: usize,
    /// A face that is not positive, if there is one.
    pub first_bad_face: Option<usize>,
}

impl Orientations {
    /// Whether every face is positive.
    pub fn all_positive(&self) -> bool {
        self.first_bad_face.is_none()
    }
}

/// Crossings of the boundary of a map with itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
#[must_use = "it may say that the boundary crosses itself"]
pub struct Crossings {
    /// Pairs of boundary edges that meet where they should not.
    pub count: usize,
    /// A vertex of each of two edges that cross.
    pub first: Option<[usize; 2]>,
}

/// The exact verdict on a map. Signs of areas and crossings are decided by exact predicates on the
/// very numbers given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
#[must_use = "it may say that the map is not injective"]
pub struct Certificate {
    /// Whether every face is positive and no boundary edges cross, on one oriented disk: then the
    /// map is injective.
    pub injective: bool,
    /// Orientation of the faces.
    pub orientations: Orientations,
    /// Crossings of the boundary.
    pub crossings: Crossings,
}

impl Certificate {
    /// An empty one for the library to fill.
    pub(crate) fn raw() -> sys::beltrami_certificate {
        sys::beltrami_certificate {
            struct_size: size_of::<sys::beltrami_certificate>() as u32,
            ..Default::default()
        }
    }

    pub(crate) fn new(raw: &sys::beltrami_certificate) -> Certificate {
        let [first, second] = raw.first_crossing.map(element);
        Certificate {
            injective: raw.injective != 0,
            orientations: Orientations {
                positive: count(raw.positive),
                negative: count(raw.negative),
                degenerate: count(raw.degenerate),
                first_bad_face: element(raw.first_bad_face),
            },
            crossings: Crossings {
                count: count(raw.boundary_crossings),
                first: first.zip(second).map(|(first, second)| [first, second]),
            },
        }
    }

    /// Where the map is not injective.
    pub(crate) fn bad_element(&self) -> Option<Element> {
        let crossing = || self.crossings.first.map(|[vertex, _]| Element::Vertex(vertex));
        self.orientations.first_bad_face.map(Element::Face).or_else(crossing)
    }
}

/// Distortion of a map: means over the faces weighted by 3D area, at the scale of the UVs as given;
/// NaN where there is no face to count. `s1 >= s2` are the singular values of the map of a face.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Distortion {
    /// 1/2 (s1² + s2² + s1⁻² + s2⁻²), at least 2.
    pub symmetric_dirichlet: f64,
    /// (s1 - 1)² + (1/s2 - 1)², at least 0.
    pub symmetric_arap: f64,
    /// The greatest symmetric Dirichlet energy of a face.
    pub max: f64,
    /// The face that has it.
    pub worst_face: Option<usize>,
    /// Faces left out: those without 3D area, and those that are flipped or degenerate in UV.
    pub left_out: usize,
}

impl Distortion {
    /// An empty one for the library to fill.
    pub(crate) fn raw() -> sys::beltrami_energy {
        sys::beltrami_energy {
            struct_size: size_of::<sys::beltrami_energy>() as u32,
            ..Default::default()
        }
    }

    pub(crate) fn new(raw: &sys::beltrami_energy) -> Distortion {
        Distortion {
            symmetric_dirichlet: raw.symmetric_dirichlet,
            symmetric_arap: raw.symmetric_arap,
            max: raw.max,
            worst_face: element(raw.worst_face),
            left_out: count(raw.left_out),
        }
    }
}

/// A count of things in memory.
pub(crate) fn count(raw: u64) -> usize {
    usize::try_from(raw).expect("what is in memory can be counted")
}

/// An index, or `None` for the library's "no element".
pub(crate) fn element(raw: u64) -> Option<usize> {
    (raw != sys::BELTRAMI_NO_ELEMENT).then(|| count(raw))
}
