#![doc = include_str!("../README.md")]

mod atlas;
mod atlas_check;
mod atlas_report;
mod bake;
mod check;
mod context;
mod control;
mod editor;
mod editor_report;
mod error;
mod flattener;
mod host_loop;
mod library;
mod mesh;
#[cfg(feature = "mint")]
mod mint;
#[cfg(feature = "ndarray")]
mod ndarray;
mod options;
mod packer;
mod packing;
mod parameterization;
mod surface;
mod unwrapper;
mod verdict;
mod view;

pub use atlas::Atlas;
pub use atlas_check::{
    check_atlas, check_atlas_with, triangulate, AtlasCheck, AtlasRules, Triangulation,
};
pub use atlas_report::{AtlasCertificate, AtlasSummary, Chart};
pub use bake::{Bake, Baked, Filter, Image, Pixel, PixelKind, Wrap};
pub use check::{
    check_boundary, check_boundary_with, check_injective, check_injective_with, check_triangles,
    check_triangles_with, measure, measure_faces, measure_faces_with, measure_with, FaceDistortion,
};
pub use control::{CancelToken, Control, Progress};
pub use editor::Editor;
pub use editor_report::{Budget, Changes, ChartFlags, EditorChart, EditorSummary, Mark};
pub use error::{Element, Error, ErrorKind};
pub use flattener::Flattener;
pub use library::{build_info, has, version};
pub use mesh::{Faces, Mesh, Positions, Uv, Uvs, UvsMut};
pub use options::{
    Cut, Delaunay, Effort, Energy, Flatten, Injectivity, Method, OptionInfo, OptionKind, Options,
    Pack, PackOptions, PackTurns, Preset, Rectify, Stack, UnwrapOptions, Weld, OPTIONS,
};
pub use packer::{Packer, UvMesh};
pub use packing::{Packing, PageSummary, Texel};
pub use parameterization::{Parameterization, Stage, Status, Summary};
pub use surface::{Edges, Integers, PinKind, Quadruples, Reals, Surface};
pub use unwrapper::Unwrapper;
pub use verdict::{Certificate, Crossings, Distortion, Orientations};
pub use view::{Index, Real, Scalar, View, ViewMut, WideIndex};

/// Guides whose snippets are documentation tests.
#[cfg(doctest)]
#[doc = include_str!("guides/pins.md")]
#[doc = include_str!("guides/project.md")]
#[doc = include_str!("guides/rust.md")]
mod guides {}
