//! What an editor says of itself, and how long it goes on.

use beltrami_sys as sys;

use crate::parameterization::Status;
use crate::verdict::count;

/// How long [`Editor::update_with`](crate::Editor::update_with) goes on: by default until all maps are at their minimum.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
#[must_use = "pass it to an update"]
pub struct Budget {
    /// Newton steps that a chart takes at most from the map that it has; 0: any number. A drag
    /// wants 1 or 2.
    pub steps: u32,
    /// Wall time after which no further step is begun; 0: any.
    pub seconds: f64,
}

impl Budget {
    /// To the minimum.
    pub fn new() -> Budget {
        Budget::default()
    }

    /// So many steps at most.
    pub fn steps(mut self, steps: u32) -> Budget {
        self.steps = steps;
        self
    }

    /// So much wall time.
    pub fn seconds(mut self, seconds: f64) -> Budget {
        self.seconds = seconds;
        self
    }
}

/// Corners that the last update, pack or restore moved, and where they are now.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Changes<T> {
    /// Counted from 0, face after face, increasing.
    pub corners: Vec<usize>,
    /// One for each.
    pub uvs: Vec<T>,
}

/// How an editor stands.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct EditorSummary {
    /// The greatest reservation of all charts.
    pub status: Status,
    /// Number of charts.
    pub charts: usize,
    /// Charts that are to be mapped further.
    pub due: usize,
    /// Edges that had to be cut beside the seams.
    pub opened: usize,
    /// Mean over the area, each chart at its scale; NaN before the first update.
    pub symmetric_dirichlet: f64,
    /// Wall time of the last update, pack or check.
    pub seconds: f64,
    /// Processor time of the whole process during it.
    pub cpu_seconds: f64,
}

/// What a chart keeps, beside its lock: nothing by default.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub struct ChartFlags {
    /// Packing does not turn it.
    pub keep_frame: bool,
    /// Pins leave its size, and packing those of all charts.
    pub keep_scale: bool,
    /// What is straight of its border lies along the axes.
    pub align: bool,
    /// Packing lays it on the first chart of its shape that has this flag.
    pub stack: bool,
}

impl ChartFlags {
    fn bits(self) -> [(bool, u32); 4] {
        [
            (self.keep_frame, sys::BELTRAMI_CHART_KEEP_FRAME as u32),
            (self.keep_scale, sys::BELTRAMI_CHART_KEEP_SCALE as u32),
            (self.align, sys::BELTRAMI_CHART_ALIGN as u32),
            (self.stack, sys::BELTRAMI_CHART_STACK as u32),
        ]
    }

    pub(crate) fn raw(self) -> u32 {
        self.bits().iter().filter(|(on, _)| *on).map(|(_, bit)| bit).sum()
    }

    fn from_raw(raw: u32) -> ChartFlags {
        let [keep_frame, keep_scale, align, stack] =
            ChartFlags::default().bits().map(|(_, bit)| raw & bit != 0);
        ChartFlags { keep_frame, keep_scale, align, stack }
    }
}

/// A chart of an editor.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct EditorChart {
    /// Its number, which it keeps while most of it stays, and which is given once.
    pub id: u64,
    /// By itself.
    pub status: Status,
    /// Whether it is to be mapped further.
    pub due: bool,
    /// Whether all of its faces are locked.
    pub locked: bool,
    /// Number of its triangles.
    pub triangles: usize,
    /// The least of its faces.
    pub first_face: usize,
    /// Mean energy, at its scale.
    pub symmetric_dirichlet: f64,
    /// Lengths in the plane per length on the surface that it is to have.
    pub scale: f64,
    /// Those of all of its faces.
    pub flags: ChartFlags,
    /// The number of the chart that packing has laid it on, while both stay as they are.
    pub stacked_on: Option<u64>,
}

/// How an editor stood when [`Editor::save`](crate::Editor::save) was called.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Mark(pub(crate) u64);

impl EditorSummary {
    pub(crate) fn new(raw: &sys::beltrami_session) -> EditorSummary {
        EditorSummary {
            status: Status::from_raw(raw.status),
            charts: count(raw.charts),
            due: count(raw.due),
            opened: count(raw.opened),
            symmetric_dirichlet: raw.symmetric_dirichlet,
            seconds: raw.seconds,
            cpu_seconds: raw.cpu_seconds,
        }
    }
}

impl EditorChart {
    pub(crate) fn new(raw: &sys::beltrami_session_chart) -> EditorChart {
        EditorChart {
            id: raw.id,
            status: Status::from_raw(raw.status),
            due: raw.due != 0,
            locked: raw.locked != 0,
            triangles: count(raw.triangles),
            first_face: count(raw.first_face),
            symmetric_dirichlet: raw.symmetric_dirichlet,
            scale: raw.scale,
            flags: ChartFlags::from_raw(raw.flags),
            stacked_on: Some(raw.stacked_on).filter(|&number| number != u64::MAX),
        }
    }
}
