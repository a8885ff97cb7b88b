"""beltrami makes UVs: injective, with low distortion, of disks and of any surface as an atlas.

>>> import beltrami
>>> vertices = [[0.0, 0, 0], [1, 0, 0], [1, 1, 1], [0, 1, 0]]  # (n, 3) floats
>>> faces = [[0, 1, 2], [0, 2, 3]]  # (m, 3) integers
>>> result = beltrami.parameterize(vertices, faces)
>>> result.uv.shape, result.injective, round(result.energy.symmetric_dirichlet, 3)
((4, 2), True, 2.0)

Vertices and faces are never duplicated, dropped or reordered: there is one UV per vertex. Surfaces
that are no disk are cut into charts: every corner of every face gets a UV.

>>> atlas = beltrami.unwrap(vertices, [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]])
>>> atlas.corner_uvs.shape, atlas.injective
((4, 3, 2), True)
"""

from . import _library, plot, xatlas
from ._atlas import Atlas, SceneAtlases
from ._atlas_checks import AtlasCheck, Triangulation, check_atlas, triangulate
from ._bake import Baked, bake
from ._batch import batch
from ._cancel import CancelToken
from ._checks import Distortion, check_boundary, check_injective, check_triangles, distortion
from ._editor import Changes, Editor
from ._errors import (
    BeltramiError,
    Cancelled,
    IndexOutOfRangeError,
    InternalError,
    InvalidArgumentError,
    InvalidStateError,
    MeshError,
    NonFiniteError,
    NoRoomError,
    NotADiskError,
    NotInjectiveWarning,
    OutOfMemoryError,
    PinError,
    SolverError,
    UnsupportedError,
)
from ._flatten import Flattener, parameterize
from ._jobs import BatchRecord
from ._library import build_info
from ._pack import Packing, UvMesh, pack
from ._results import Parameterization
from ._sessions import SessionChart, SessionReport
from ._tables import (
    AtlasCertificate,
    AtlasReport,
    Certificate,
    Chart,
    Energy,
    Options,
    PackingReport,
    PackOptions,
    Report,
    Stage,
    UnwrapOptions,
)
from ._unwrap import unwrap
from ._unwrap_batch import unwrap_batch

__version__ = _library.version()
__all__ = [
    "Atlas",
    "AtlasCertificate",
    "AtlasCheck",
    "AtlasReport",
    "Baked",
    "BatchRecord",
    "BeltramiError",
    "CancelToken",
    "Cancelled",
    "Certificate",
    "Changes",
    "Chart",
    "Distortion",
    "Editor",
    "Energy",
    "Flattener",
    "IndexOutOfRangeError",
    "InternalError",
    "InvalidArgumentError",
    "InvalidStateError",
    "MeshError",
    "NoRoomError",
    "NonFiniteError",
    "NotADiskError",
    "NotInjectiveWarning",
    "Options",
    "OutOfMemoryError",
    "PackOptions",
    "Packing",
    "PackingReport",
    "Parameterization",
    "PinError",
    "Report",
    "SceneAtlases",
    "SessionChart",
    "SessionReport",
    "SolverError",
    "Stage",
    "Triangulation",
    "UnsupportedError",
    "UnwrapOptions",
    "UvMesh",
    "bake",
    "batch",
    "build_info",
    "check_atlas",
    "check_boundary",
    "check_injective",
    "check_triangles",
    "distortion",
    "pack",
    "parameterize",
    "plot",
    "triangulate",
    "unwrap",
    "unwrap_batch",
    "xatlas",
]
