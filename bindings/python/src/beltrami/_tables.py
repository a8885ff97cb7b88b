"""Options and results, from the C header and the library's table of options.

Written by ``tools/generate.py``: change it there.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypedDict

MethodChoice = Literal["beltrami", "cm", "tutte", "gif", "bff", "uv-prolongation"]
EnergyChoice = Literal["symmetric-dirichlet", "symmetric-arap"]
FlattenChoice = Literal["metric", "dirichlet", "gif", "flim", "bff"]
InjectivityChoice = Literal["auto", "global", "local"]
CutChoice = Literal["minimal", "islands"]
WeldChoice = Literal["auto", "on", "off"]


class Options(TypedDict, total=False):
    """The options of a run by keyword, all of them optional."""

    method: MethodChoice
    energy: EnergyChoice
    coarse_faces: int
    tolerance: float
    max_iterations: int
    threads: int
    unit_square: bool
    flatten: FlattenChoice
    injectivity: InjectivityChoice
    refine: bool
    refine_iterations: int
    time_limit: float
    float32: bool
    delaunay: bool
    memory_limit: int
    cut: CutChoice
    hard_angle: float
    weld: WeldChoice
    weld_distance: float
    fill_holes: float
    share_copies: bool


@dataclass(frozen=True)
class Certificate:
    """The exact verdict on a map; true where nothing bad was found.

    Attributes
    ----------
    injective : bool
        Whether the map is proven to be injective.
    positive, negative, degenerate : int
        Faces of positive, negative, zero area in UV.
    boundary_crossings : int
        Pairs of boundary edges that meet where they should not: all of * them while they are few,
        else at least so many (it takes and * lists no more than about n log n of n edges).
    first_bad_face : int | None
        A face that is not positive, or None.
    first_crossing : tuple[int, int] | None
        A vertex of each of two crossing edges, or None.
    """

    injective: bool
    positive: int
    negative: int
    degenerate: int
    boundary_crossings: int
    first_bad_face: int | None
    first_crossing: tuple[int, int] | None

    def __bool__(self) -> bool:
        """Whether no face is flipped or without area, and the boundary nowhere crosses itself."""
        return self.negative == self.degenerate == self.boundary_crossings == 0


@dataclass(frozen=True)
class Energy:
    """Distortion energies of a map: means over the faces weighted by area in space.

    Attributes
    ----------
    symmetric_dirichlet : float
        1/2 (s1^2 + s2^2 + s1^-2 + s2^-2), >= 2.
    symmetric_arap : float
        (s1 - 1)^2 + (1/s2 - 1)^2, >= 0.
    max : float
        Greatest symmetric Dirichlet energy of a face.
    worst_face : int | None
        Where, or None.
    left_out : int
        Faces left out.
    """

    symmetric_dirichlet: float
    symmetric_arap: float
    max: float
    worst_face: int | None
    left_out: int


@dataclass(frozen=True)
class Report:
    """Counts, area and cost of a run.

    Attributes
    ----------
    vertices, faces, boundary_edges : int
        Of the input.
    unreferenced_vertices : int
        Vertices that no face uses: UV (0, 0).
    coarse_faces : int
        Of the mesh that CM ran on.
    flips_before_repair : int
        Faces that were not positive before repair.
    area : float
        Of the input, in its unit squared.
    seconds : float
        Wall time of the run.
    cpu_seconds : float
        Of the whole process during the run.
    peak_memory_bytes : int
        Of the whole process so far.
    kernel_fixes : int
        Vertices that repair moved into the kernel of their one-ring.
    patch_fixes : int
        Patches that repair untangled.
    global_fixes : int
        Layouts that repair embedded anew, with a scaffold.
    cleaned_patches : int
        Patches optimised around faces of enormous energy.
    restarts : int
        Tries after the first, whose map was not injective.
    float32_moves : int
        Vertices that are not at the nearest float in F32.
    delaunay_flips : int
        With the option delaunay: edges flipped.
    delaunay_refused : int
        Edges that are not Delaunay: their flip would repeat an edge.
    degenerate_faces : int
        Of the input: faces without area, which no energy counts.
    first_degenerate_face : int | None
        The first of them, or None.
    coarse_energy : float
        Mean energy of the coarse map; 0 where CM did not run.
    """

    vertices: int
    faces: int
    boundary_edges: int
    unreferenced_vertices: int
    coarse_faces: int
    flips_before_repair: int
    area: float
    seconds: float
    cpu_seconds: float
    peak_memory_bytes: int
    kernel_fixes: int
    patch_fixes: int
    global_fixes: int
    cleaned_patches: int
    restarts: int
    float32_moves: int
    delaunay_flips: int
    delaunay_refused: int
    degenerate_faces: int
    first_degenerate_face: int | None
    coarse_energy: float


@dataclass(frozen=True)
class Stage:
    """What one stage of a run took.

    Attributes
    ----------
    iterations : int
        0 where a stage does not iterate.
    seconds : float
        Wall time.
    cpu_seconds : float
        Of the whole process.
    name : str
        "simplify", "coarse", "prolong", "flatten", "repair", ...
    """

    iterations: int
    seconds: float
    cpu_seconds: float
    name: str
