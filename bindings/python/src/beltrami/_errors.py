"""What the package raises and warns of."""

from __future__ import annotations


class BeltramiError(RuntimeError):
    """A failure of the library; there is no new result.

    Attributes
    ----------
    code : int
        Number of the status in the C interface, below 0.
    status : str
        Its name, such as "BELTRAMI_E_CLOSED".
    element : int | None
        The face or vertex of the input that the failure is about, counted from 0.
    element_kind : {"face", "vertex", "corner"} | None
        What `element` counts.

    Examples
    --------
    >>> try:
    ...     beltrami.unwrap([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 3]])
    ... except beltrami.MeshError as error:
    ...     print(error.status, error.element_kind, error.element)
    BELTRAMI_E_INDEX_OUT_OF_RANGE face 0
    """

    def __init__(
        self,
        message: str,
        code: int = 0,
        status: str = "",
        element: int | None = None,
        element_kind: str | None = None,
    ) -> None:
        super().__init__(message)
        self.code = code
        self.status = status
        self.element = element
        self.element_kind = element_kind

    def __reduce__(self) -> tuple[object, ...]:
        message = self.args[0]
        return type(self), (message, self.code, self.status, self.element, self.element_kind)


class InvalidArgumentError(BeltramiError, ValueError):
    """An option that does not exist, or a value out of its range."""


class OutOfMemoryError(BeltramiError, MemoryError):
    """There was not enough memory."""


class UnsupportedError(BeltramiError, NotImplementedError):
    """The library was built without what was asked for."""


class InvalidStateError(BeltramiError):
    """A call that comes too early, or during a run in another thread."""

    def __init__(
        self,
        message: str,
        code: int = -5,
        status: str = "BELTRAMI_E_INVALID_STATE",
        element: int | None = None,
        element_kind: str | None = None,
    ) -> None:
        super().__init__(message, code, status, element, element_kind)


class Cancelled(BeltramiError):  # noqa: N818 - an outcome rather than an error
    """The run was cancelled: by `Flattener.cancel`, or by a progress callback."""


class InternalError(BeltramiError):
    """A defect of the library: please report it together with the mesh."""


class SolverError(BeltramiError):
    """A linear system could not be solved."""


class MeshError(BeltramiError, ValueError):
    """The mesh is not one that can be flattened: no faces, or no area."""


class IndexOutOfRangeError(MeshError, IndexError):
    """A face names a vertex that does not exist; `element` is the face."""


class NonFiniteError(MeshError):
    """A coordinate is infinite or not a number; `element` is the vertex."""


class NotADiskError(MeshError):
    """The surface is not one oriented disk; `status` says why, `element` where.

    It may be closed, have several components, boundary loops or handles, an edge or a vertex where
    more than one sheet meets, or faces that run against each other. `unwrap` takes such surfaces.
    """


class PinError(BeltramiError):
    """Corners cannot be held where they were pinned: no injective map does that.

    Its element is the first corner that cannot be met together with those before it. Where a chart
    cannot be made straight it is the face of a rectangle, or a vertex of straight edges.
    """


class NoRoomError(BeltramiError):
    """The charts do not fit onto the pages that the options allow."""


class NotInjectiveWarning(UserWarning):
    """A result is not injective: its certificate says where."""


# By the names of the statuses; what is not here is a plain BeltramiError.
ERRORS: dict[str, type[BeltramiError]] = {
    "BELTRAMI_E_INVALID_ARGUMENT": InvalidArgumentError,
    "BELTRAMI_E_OUT_OF_MEMORY": OutOfMemoryError,
    "BELTRAMI_E_UNSUPPORTED": UnsupportedError,
    "BELTRAMI_E_INVALID_STATE": InvalidStateError,
    "BELTRAMI_E_CANCELLED": Cancelled,
    "BELTRAMI_E_INTERNAL": InternalError,
    "BELTRAMI_E_EMPTY": MeshError,
    "BELTRAMI_E_INDEX_OUT_OF_RANGE": IndexOutOfRangeError,
    "BELTRAMI_E_NON_FINITE": NonFiniteError,
    "BELTRAMI_E_REPEATED_VERTEX": NotADiskError,
    "BELTRAMI_E_NON_MANIFOLD_EDGE": NotADiskError,
    "BELTRAMI_E_NON_MANIFOLD_VERTEX": NotADiskError,
    "BELTRAMI_E_ORIENTATION": NotADiskError,
    "BELTRAMI_E_COMPONENTS": NotADiskError,
    "BELTRAMI_E_CLOSED": NotADiskError,
    "BELTRAMI_E_BOUNDARIES": NotADiskError,
    "BELTRAMI_E_GENUS": NotADiskError,
    "BELTRAMI_E_ZERO_AREA": MeshError,
    "BELTRAMI_E_PINS": PinError,
    "BELTRAMI_E_NO_ROOM": NoRoomError,
    "BELTRAMI_E_SOLVER": SolverError,
}
