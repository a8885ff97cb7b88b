"""beltrami flattens disk-like triangle meshes to UVs: injective, with low distortion.

>>> import beltrami
>>> vertices = [[0.0, 0, 0], [1, 0, 0], [1, 1, 1], [0, 1, 0]]  # (n, 3) floats
>>> faces = [[0, 1, 2], [0, 2, 3]]  # (m, 3) integers
>>> result = beltrami.parameterize(vertices, faces)
>>> result.uv.shape, result.injective, round(result.energy.symmetric_dirichlet, 3)
((4, 2), True, 2.0)

Vertices and faces are never duplicated, dropped or reordered: there is one UV per vertex.
"""

from . import _library, plot
from ._batch import BatchRecord, batch
from ._checks import Distortion, check_boundary, check_injective, check_triangles, distortion
from ._errors import (
    BeltramiError,
    Cancelled,
    IndexOutOfRangeError,
    InternalError,
    InvalidArgumentError,
    InvalidStateError,
    MeshError,
    NonFiniteError,
    NotADiskError,
    NotInjectiveWarning,
    OutOfMemoryError,
    SolverError,
    UnsupportedError,
)
from ._flatten import Flattener, parameterize
from ._library import build_info
from ._results import Parameterization
from ._tables import Certificate, Energy, Options, Report, Stage

__version__ = _library.version()
__all__ = [
    "BatchRecord",
    "BeltramiError",
    "Cancelled",
    "Certificate",
    "Distortion",
    "Energy",
    "Flattener",
    "IndexOutOfRangeError",
    "InternalError",
    "InvalidArgumentError",
    "InvalidStateError",
    "MeshError",
    "NonFiniteError",
    "NotADiskError",
    "NotInjectiveWarning",
    "Options",
    "OutOfMemoryError",
    "Parameterization",
    "Report",
    "SolverError",
    "Stage",
    "UnsupportedError",
    "batch",
    "build_info",
    "check_boundary",
    "check_injective",
    "check_triangles",
    "distortion",
    "parameterize",
    "plot",
]
