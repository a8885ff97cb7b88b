//! What goes wrong, and where in the mesh.

use std::error;
use std::ffi::CStr;
use std::fmt;
use std::os::raw::c_char;

use beltrami_sys as sys;

/// A face, vertex or corner of the caller's mesh, counted from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Element {
    /// The index of a face.
    Face(usize),
    /// The index of a vertex.
    Vertex(usize),
    /// The index of a corner of a surface: of one vertex of one face, face after face.
    Corner(usize),
}

impl Element {
    /// The element that the library names by a `BELTRAMI_ELEMENT_` number and an index.
    pub(crate) fn new(kind: i32, index: u64) -> Option<Element> {
        let index = usize::try_from(index).ok()?;
        match kind {
            sys::BELTRAMI_ELEMENT_FACE => Some(Element::Face(index)),
            sys::BELTRAMI_ELEMENT_VERTEX => Some(Element::Vertex(index)),
            sys::BELTRAMI_ELEMENT_CORNER => Some(Element::Corner(index)),
            _ => None,
        }
    }
}

impl fmt::Display for Element {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Element::Face(index) => write!(formatter, "face {index}"),
            Element::Vertex(index) => write!(formatter, "vertex {index}"),
            Element::Corner(index) => write!(formatter, "corner {index}"),
        }
    }
}

/// Defines `ErrorKind` and its two ways to and from the statuses of the library.
macro_rules! error_kinds {
    ($( $(#[$doc:meta])* $kind:ident = $status:ident, )*) => {
        /// What kind of failure an [`Error`] is.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum ErrorKind {
            $( $(#[$doc])* $kind, )*
            /// A status that a newer library has and this crate does not know.
            Other(i32),
        }

        impl ErrorKind {
            /// The kind that stands for a status of the library, a `BELTRAMI_` number.
            pub(crate) fn from_status(status: sys::beltrami_status) -> ErrorKind {
                match status {
                    $( sys::$status => ErrorKind::$kind, )*
                    other => ErrorKind::Other(other),
                }
            }

            /// The number in the C interface, a `beltrami_status`.
            pub fn status(self) -> i32 {
                match self {
                    $( ErrorKind::$kind => sys::$status, )*
                    ErrorKind::Other(status) => status,
                }
            }
        }
    };
}

error_kinds! {
    /// The call itself is wrong: an option out of range, arrays whose lengths do not fit together.
    InvalidArgument = BELTRAMI_E_INVALID_ARGUMENT,
    /// There is not enough memory.
    OutOfMemory = BELTRAMI_E_OUT_OF_MEMORY,
    /// The library that the program runs with has another binary interface than this crate.
    AbiMismatch = BELTRAMI_E_ABI_MISMATCH,
    /// This build of the library does not have what was asked for.
    Unsupported = BELTRAMI_E_UNSUPPORTED,
    /// The call comes too early: a run without a mesh.
    InvalidState = BELTRAMI_E_INVALID_STATE,
    /// A [`CancelToken`](crate::CancelToken) or the progress closure ended the run.
    Cancelled = BELTRAMI_E_CANCELLED,
    /// A defect of the library: please report it with the mesh.
    Internal = BELTRAMI_E_INTERNAL,
    /// The mesh has no vertices or no faces.
    Empty = BELTRAMI_E_EMPTY,
    /// A face names a vertex that there is not.
    IndexOutOfRange = BELTRAMI_E_INDEX_OUT_OF_RANGE,
    /// A coordinate is NaN or infinite.
    NonFinite = BELTRAMI_E_NON_FINITE,
    /// A face names one vertex twice.
    RepeatedVertex = BELTRAMI_E_REPEATED_VERTEX,
    /// An edge of the face has more than two faces.
    NonManifoldEdge = BELTRAMI_E_NON_MANIFOLD_EDGE,
    /// The faces of the vertex form more than one fan.
    NonManifoldVertex = BELTRAMI_E_NON_MANIFOLD_VERTEX,
    /// A face runs against its neighbour, or is a duplicate.
    Orientation = BELTRAMI_E_ORIENTATION,
    /// The face is in a second component.
    Components = BELTRAMI_E_COMPONENTS,
    /// The mesh has no boundary: cut it open first.
    Closed = BELTRAMI_E_CLOSED,
    /// The vertex is on a second boundary loop.
    Boundaries = BELTRAMI_E_BOUNDARIES,
    /// The mesh has handles: cut them open first.
    Genus = BELTRAMI_E_GENUS,
    /// The whole surface has no area, or its area overflows.
    ZeroArea = BELTRAMI_E_ZERO_AREA,
    /// Corners cannot be held where they were pinned: no injective map does that.
    Pins = BELTRAMI_E_PINS,
    /// The charts do not fit onto the pages that the options allow.
    NoRoom = BELTRAMI_E_NO_ROOM,
    /// A linear system could not be solved.
    Solver = BELTRAMI_E_SOLVER,
    /// There is a map, but it is not injective: only what asks for injectivity fails so, see
    /// [`Parameterization::ensure_injective`](crate::Parameterization::ensure_injective).
    NotInjective = BELTRAMI_NOT_INJECTIVE,
    /// There is a map that is injective in double precision, but none in the single precision that
    /// was asked for.
    NotInjectiveFloat32 = BELTRAMI_NOT_INJECTIVE_FLOAT32,
}

/// A failure: its kind, the face or vertex concerned, and words that say what to do.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Error {
    /// What kind of failure it is.
    pub kind: ErrorKind,
    /// The face or vertex that is the cause, where one is.
    pub element: Option<Element>,
    /// What happened and what to do about it, with the element where there is one.
    pub message: Box<str>,
}

impl Error {
    /// A failure that this crate itself found.
    pub(crate) fn new(kind: ErrorKind, message: impl Into<Box<str>>) -> Error {
        Error { kind, element: None, message: message.into() }
    }

    /// A wrong argument that this crate itself found.
    pub(crate) fn argument(message: impl Into<Box<str>>) -> Error {
        Error::new(ErrorKind::InvalidArgument, message)
    }

    /// A status of the library, in its general words.
    pub(crate) fn from_status(status: sys::beltrami_status, element: Option<Element>) -> Error {
        let message = match element {
            Some(element) => format!("{} See {element}.", advice(status)).into(),
            None => advice(status).into(),
        };
        Error { kind: ErrorKind::from_status(status), element, message }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.message)
    }
}

impl error::Error for Error {}

/// One sentence on what a status means and what to do about it.
pub(crate) fn advice(status: sys::beltrami_status) -> &'static str {
    // SAFETY: any number will do; the text is static.
    unsafe { static_text(sys::beltrami_status_advice(status)) }
}

/// A text of the library's that lasts as long as the program.
///
/// # Safety
///
/// `text` is a static, NUL-terminated string.
pub(crate) unsafe fn static_text(text: *const c_char) -> &'static str {
    // SAFETY: the caller's promise. All texts of the library are ASCII.
    unsafe { CStr::from_ptr::<'static>(text) }.to_str().unwrap_or_default()
}
