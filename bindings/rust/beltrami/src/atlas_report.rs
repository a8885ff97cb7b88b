//! What the library has to say of atlases: verdict, counts, charts.

use std::mem::size_of;

use beltrami_sys as sys;

use crate::error::{Element, ErrorKind};
use crate::parameterization::Status;
use crate::verdict::{count, element};

/// The exact verdict on an atlas: every triangle positive, no two with a common inner point, in one
/// chart or in two. Signs are decided by exact predicates on the very numbers given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
#[must_use = "it may say that the atlas is not injective"]
pub struct AtlasCertificate {
    /// Whether all triangles are positive, and no two overlap.
    pub injective: bool,
    /// Triangles of positive area in UV.
    pub positive: usize,
    /// Triangles of negative area: flipped.
    pub negative: usize,
    /// Triangles of no area.
    pub degenerate: usize,
    /// Triangles that are not judged: without area on the surface, or sharing the UVs of a copy.
    pub excepted: usize,
    /// Charts that were negative as a whole, taken as their mirror images.
    pub mirrored_charts: usize,
    /// Triangles in them.
    pub mirrored_faces: usize,
    /// Pairs of triangles that overlap, one at least at a seam or border: all of them while they are
    /// few, else at least so many.
    pub overlaps: usize,
    /// Two faces that overlap.
    pub first_overlap: Option<[usize; 2]>,
    /// A face that is not positive.
    pub first_bad_face: Option<usize>,
    /// Where borders touch, which is allowed.
    pub touching_places: usize,
}

impl AtlasCertificate {
    /// An empty one for the library to fill.
    pub(crate) fn raw() -> sys::beltrami_atlas_certificate {
        sys::beltrami_atlas_certificate {
            struct_size: size_of::<sys::beltrami_atlas_certificate>() as u32,
            ..Default::default()
        }
    }

    pub(crate) fn new(raw: &sys::beltrami_atlas_certificate) -> AtlasCertificate {
        let [first, second] = raw.first_overlap.map(element);
        AtlasCertificate {
            injective: raw.injective != 0,
            positive: count(raw.positive),
            negative: count(raw.negative),
            degenerate: count(raw.degenerate),
            excepted: count(raw.excepted),
            mirrored_charts: count(raw.mirrored_charts),
            mirrored_faces: count(raw.mirrored_faces),
            overlaps: count(raw.overlaps),
            first_overlap: first.zip(second).map(|(first, second)| [first, second]),
            first_bad_face: element(raw.first_bad_face),
            touching_places: count(raw.touching_places),
        }
    }

    /// Where the atlas is not injective.
    pub(crate) fn bad_element(&self) -> Option<Element> {
        let overlap = || self.first_overlap.map(|[face, _]| face);
        self.first_bad_face.or_else(overlap).map(Element::Face)
    }
}

/// What was met in a surface and made of it. Triangles are those of
/// [`triangulate`](crate::triangulate), faces the input's.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct AtlasSummary {
    /// Vertices of the input.
    pub vertices: usize,
    /// Faces of the input.
    pub faces: usize,
    /// Corners of its faces.
    pub corners: usize,
    /// Triangles that were computed on.
    pub triangles: usize,
    /// Pieces of the layout.
    pub charts: usize,
    /// What a vertex buffer needs: vertices, split along the seams.
    pub uv_vertices: usize,
    /// Vertices that no face names.
    pub unused_vertices: usize,
    /// Vertices that count as one with a vertex before them.
    pub welded_vertices: usize,
    /// Triangles that name a vertex twice: each gets a point.
    pub repeated_faces: usize,
    /// Other triangles without area: each gets a point.
    pub faces_without_area: usize,
    /// Triangles with the vertices of one before them: each lies in a layer of its own, or shares
    /// the UVs of the first.
    pub copies: usize,
    /// Edges of more than two triangles, which part there.
    pub crowded_edges: usize,
    /// Edges where the sides of a one-sided surface part.
    pub one_sided_edges: usize,
    /// Vertices where fans of faces met in one point only.
    pub split_vertices: usize,
    /// Triangles turned over to agree with most of their component.
    pub reversed_faces: usize,
    /// Connected pieces of the surface.
    pub components: usize,
    /// Those without a boundary.
    pub closed_components: usize,
    /// Boundaries but for the first of each component.
    pub holes: usize,
    /// Boundaries that cost no seam.
    pub filled_holes: usize,
    /// Triangles that no energy counts: flipped, or without area.
    pub left_out: usize,
    /// Area of the surface, in its unit squared.
    pub area: f64,
    /// Edges in [`Atlas::seams`](crate::Atlas::seams).
    pub seams: usize,
    /// Length of the seams on the surface, each counted once, without open borders.
    pub seam_length: f64,
    /// Area of the UVs over that of the pages; of an atlas that is not packed over that of their
    /// bounding box.
    pub utilisation: f64,
    /// Mean symmetric Dirichlet energy over the area, at one scale for all: at least 2.
    pub symmetric_dirichlet: f64,
    /// The energy that is exceeded on 1% of the area at most.
    pub p99: f64,
    /// The greatest energy of a triangle.
    pub max: f64,
    /// Wall time of the run.
    pub seconds: f64,
    /// Processor time of the whole process during the run.
    pub cpu_seconds: f64,
    /// The most memory that the whole process has had so far.
    pub peak_memory_bytes: u64,
    /// Pages; 0 where the atlas is not packed.
    pub pages: usize,
    /// Triangles that no energy counts: the worst ones, which together have less than a millionth
    /// of the area.
    pub slivers: usize,
    /// The mean energy with them.
    pub symmetric_dirichlet_with_slivers: f64,
    /// The greatest energy with them.
    pub max_with_slivers: f64,
    /// Components, as the given cuts part them, that miss the energy or percentile that seams were
    /// searched for: each is to have it.
    pub missed_parts: usize,
    /// The first face of the worst of them.
    pub missed_face: Option<usize>,
    /// Triangles of that part.
    pub missed_triangles: usize,
    /// Its mean energy; 0 where there is none.
    pub missed_energy: f64,
    /// Components that lie on others of their shape: no area, energy or verdict counts them.
    pub stacked_parts: usize,
}

impl AtlasSummary {
    pub(crate) fn new(raw: &sys::beltrami_atlas) -> AtlasSummary {
        AtlasSummary {
            vertices: count(raw.vertices),
            faces: count(raw.faces),
            corners: count(raw.corners),
            triangles: count(raw.triangles),
            charts: count(raw.charts),
            uv_vertices: count(raw.uv_vertices),
            unused_vertices: count(raw.unused_vertices),
            welded_vertices: count(raw.welded_vertices),
            repeated_faces: count(raw.repeated_faces),
            faces_without_area: count(raw.faces_without_area),
            copies: count(raw.copies),
            crowded_edges: count(raw.crowded_edges),
            one_sided_edges: count(raw.one_sided_edges),
            split_vertices: count(raw.split_vertices),
            reversed_faces: count(raw.reversed_faces),
            components: count(raw.components),
            closed_components: count(raw.closed_components),
            holes: count(raw.holes),
            filled_holes: count(raw.filled_holes),
            left_out: count(raw.left_out),
            area: raw.area,
            seams: count(raw.seams),
            seam_length: raw.seam_length,
            utilisation: raw.utilisation,
            symmetric_dirichlet: raw.symmetric_dirichlet,
            p99: raw.p99,
            max: raw.max,
            seconds: raw.seconds,
            cpu_seconds: raw.cpu_seconds,
            peak_memory_bytes: raw.peak_memory_bytes,
            pages: count(raw.pages),
            slivers: count(raw.slivers),
            symmetric_dirichlet_with_slivers: raw.symmetric_dirichlet_with_slivers,
            max_with_slivers: raw.max_with_slivers,
            missed_parts: count(raw.missed_parts),
            missed_face: element(raw.missed_face),
            missed_triangles: count(raw.missed_triangles),
            missed_energy: raw.missed_energy,
            stacked_parts: count(raw.stacked_parts),
        }
    }
}

/// A chart: a connected piece of the surface.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Chart {
    /// Which promise its map keeps.
    pub status: Status,
    /// Why it has no map but one point.
    pub error: Option<ErrorKind>,
    /// Number of its triangles.
    pub triangles: usize,
    /// The least of its faces.
    pub first_face: usize,
    /// Area on the surface, in its unit squared.
    pub area: f64,
    /// Mean of its faces' densities; 1 without.
    pub density: f64,
    /// Mean symmetric Dirichlet energy over its area, at the scale of the atlas.
    pub symmetric_dirichlet: f64,
    /// The greatest energy of a triangle.
    pub max: f64,
    /// Box of its UVs: the least (u, v) and the greatest.
    pub uv_box: [[f64; 2]; 2],
    /// The page that it lies on, counted from 0; 0 where the atlas is not packed.
    pub page: usize,
}

impl Chart {
    pub(crate) fn new(raw: &sys::beltrami_chart) -> Chart {
        let [u0, v0, u1, v1] = raw.box_;
        Chart {
            status: Status::from_raw(raw.status),
            error: (raw.error != sys::BELTRAMI_OK).then(|| ErrorKind::from_status(raw.error)),
            triangles: count(raw.triangles),
            first_face: count(raw.first_face),
            area: raw.area,
            density: raw.density,
            symmetric_dirichlet: raw.symmetric_dirichlet,
            max: raw.max,
            uv_box: [[u0, v0], [u1, v1]],
            page: count(raw.page),
        }
    }
}
