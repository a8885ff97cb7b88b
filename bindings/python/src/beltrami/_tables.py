"""Options and results, from the C header and the library's table of options.

Written by ``tools/generate.py``: change it there.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypedDict

MethodChoice = Literal["beltrami", "cm", "tutte", "gif", "bff", "uv-prolongation"]
EnergyChoice = Literal["symmetric-dirichlet", "symmetric-arap", "exponential-dirichlet"]
FlattenChoice = Literal["metric", "dirichlet", "gif", "flim", "bff"]
InjectivityChoice = Literal["auto", "global", "local"]
CutChoice = Literal["minimal", "islands", "auto", "given"]
WeldChoice = Literal["auto", "on", "off"]
PresetChoice = Literal["none", "lightmap", "texturing", "one-chart", "hard-surface"]
PackChoice = Literal["pages", "none"]
PackTurnsChoice = Literal["any", "quarter", "none"]
EffortChoice = Literal["quick", "normal", "high"]
StackChoice = Literal["none", "copies", "mirrored", "halves"]
RectifyChoice = Literal["none", "grids"]

#: Options that None leaves to the option `preset`.
OF_PRESETS = (
    "target_energy",
    "max_charts",
    "concave_seams",
    "hidden_seams",
    "hard_seams",
    "flat_seams",
)


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


class UnwrapOptions(TypedDict, total=False):
    """The options of `unwrap` by keyword, all of them optional."""

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
    memory_limit: int
    cut: CutChoice
    hard_angle: float
    weld: WeldChoice
    weld_distance: float
    fill_holes: float
    share_copies: bool
    preset: PresetChoice
    target_energy: float
    target_p99: float
    max_charts: int
    seam_budget: float
    concave_seams: float
    hidden_seams: float
    hard_seams: float
    material_seams: float
    pack: PackChoice
    resolution: int
    margin: float
    texels_per_unit: float
    max_pages: int
    pack_turns: PackTurnsChoice
    pack_block: int
    fill_weight: float
    symmetric_seams: float
    straight_seams: float
    effort: EffortChoice
    flat_seams: float
    stack: StackChoice
    rectify: RectifyChoice
    snap_texels: bool
    label_pages: bool


class PackOptions(TypedDict, total=False):
    """The options of `pack` by keyword, all of them optional."""

    threads: int
    float32: bool
    resolution: int
    margin: float
    texels_per_unit: float
    max_pages: int
    pack_turns: PackTurnsChoice
    pack_block: int


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
        Pairs of boundary edges that meet where they should not: of n edges all pairs while they are
        fewer than about n log n, else at least so many.
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


@dataclass(frozen=True)
class AtlasReport:
    """What was made of a surface: counts, energy and cost.

    Attributes
    ----------
    vertices, faces : int
        Of the input.
    corners : int
        Of its faces.
    triangles : int
        Of `triangulate`: what is computed on.
    charts : int
        Pieces of the layout.
    uv_vertices : int
        What a vertex buffer needs: vertices, split along the seams.
    unused_vertices : int
        Vertices that no face names.
    welded_vertices : int
        Vertices that count as one with a vertex before them.
    repeated_faces : int
        Triangles that name a vertex twice: each gets a point.
    faces_without_area : int
        Others without area (of the largest triangle, or the square of their longest edge, 1e-14):
        each gets a point.
    copies : int
        Triangles with the vertices of one before them: each lies in a layer of its own, or shares
        the UVs of the first.
    crowded_edges : int
        Edges of more than two triangles, where flat sheets stay whole.
    one_sided_edges : int
        Edges where the sides of a one-sided surface part.
    split_vertices : int
        Vertices where fans of faces met in one point only.
    reversed_faces : int
        Triangles turned over to agree with most of their component; those with a short border part
        from it instead.
    components : int
        Connected pieces of the surface.
    closed_components : int
        Those without a boundary.
    holes : int
        Boundaries but for the first of each component.
    filled_holes : int
        Boundaries that cost no seam.
    left_out : int
        Triangles that no energy counts: flipped, or without area.
    area : float
        Of the surface, in its unit squared.
    seam_length : float
        On the surface, each seam once, no open border.
    utilisation : float
        Area of the UVs over that of the pages, or where it is not packed of their bounding box.
    symmetric_dirichlet : float
        Mean energy over the area, at one scale for all: >= 2.
    p99 : float
        Energy that is exceeded on 1% of the area at most.
    max : float
        Greatest energy of a triangle.
    seconds : float
        Wall time of the run.
    cpu_seconds : float
        Of the whole process during the run.
    peak_memory_bytes : int
        Of the whole process so far.
    seams : int
        Edges in `Atlas.seams`.
    searched : bool
        Whether seams were searched for: with cut="auto".
    reached : bool
        Whether those meet what was asked for: energy (to 0.0001), p99, charts (or one for each
        component), seam length.
    pages : int
        0 where the atlas is not packed: `Atlas.packing` has the rest.
    slivers : int
        Triangles that no energy above counts: the worst ones, which together have less than a
        millionth of the area.
    symmetric_dirichlet_with_slivers : float
        What it would be with them.
    max_with_slivers : float
        Likewise.
    missed_parts : int
        Components, as the cuts that are given part them, that miss the energy or p99 that seams
        were searched for: each is to have it.
    missed_face : int | None
        The first face of the worst of them, or None.
    missed_triangles : int
        Of that part.
    missed_energy : float
        Its mean.
    stacked_parts : int
        Components that lie on others of their shape, by the option stack: no area, energy or
        verdict counts them.
    """

    vertices: int
    faces: int
    corners: int
    triangles: int
    charts: int
    uv_vertices: int
    unused_vertices: int
    welded_vertices: int
    repeated_faces: int
    faces_without_area: int
    copies: int
    crowded_edges: int
    one_sided_edges: int
    split_vertices: int
    reversed_faces: int
    components: int
    closed_components: int
    holes: int
    filled_holes: int
    left_out: int
    area: float
    seam_length: float
    utilisation: float
    symmetric_dirichlet: float
    p99: float
    max: float
    seconds: float
    cpu_seconds: float
    peak_memory_bytes: int
    seams: int
    searched: bool
    reached: bool
    pages: int
    slivers: int
    symmetric_dirichlet_with_slivers: float
    max_with_slivers: float
    missed_parts: int
    missed_face: int | None
    missed_triangles: int
    missed_energy: float
    stacked_parts: int


@dataclass(frozen=True)
class Chart:
    """A chart of an atlas: a connected piece of the surface.

    Attributes
    ----------
    status : str
        "BELTRAMI_OK", "BELTRAMI_NOT_CONVERGED", "BELTRAMI_NOT_INJECTIVE" or
        "BELTRAMI_NOT_INJECTIVE_FLOAT32".
    error : str
        Why it has no map but one point, e.g. "BELTRAMI_E_SOLVER"; else "BELTRAMI_OK".
    triangles : int
        Of the surface.
    first_face : int
        The least face of the input.
    area : float
        On the surface, in its unit squared.
    density : float
        Mean of its faces' densities, or what its pins ask for; else 1.
    symmetric_dirichlet : float
        As of the atlas.
    max : float
        Greatest energy of a triangle.
    box : tuple[float, float, float, float]
        Of its UVs: least u, least v, greatest u, greatest v.
    page : int
        Counted from 0; 0 where the atlas is not packed.
    """

    status: str
    error: str
    triangles: int
    first_face: int
    area: float
    density: float
    symmetric_dirichlet: float
    max: float
    box: tuple[float, float, float, float]
    page: int


@dataclass(frozen=True)
class AtlasCertificate:
    """The exact verdict on an atlas; true where it is injective.

    Attributes
    ----------
    injective : bool
        Whether all triangles are positive, and no two overlap.
    positive, negative, degenerate : int
        Triangles of positive, negative, zero area in UV.
    excepted : int
        Triangles not judged: without area on the surface, or sharing UVs.
    mirrored_charts : int
        Charts that were negative as a whole, taken as their mirror images.
    mirrored_faces : int
        Triangles in them.
    overlaps : int
        Pairs of triangles that overlap, one at least at a seam or border: all of them while they
        are few, else at least so many.
    first_overlap : tuple[int, int] | None
        Two faces that overlap, or None.
    first_bad_face : int | None
        A face that is not positive, or None.
    touching_places : int
        Where borders touch, which is allowed.
    """

    injective: bool
    positive: int
    negative: int
    degenerate: int
    excepted: int
    mirrored_charts: int
    mirrored_faces: int
    overlaps: int
    first_overlap: tuple[int, int] | None
    first_bad_face: int | None
    touching_places: int

    def __bool__(self) -> bool:
        """Whether the atlas is injective."""
        return self.injective


@dataclass(frozen=True)
class PackingReport:
    """What lies on the pages of a texture: counts, density, margin and cost.

    Attributes
    ----------
    charts : int
        Pieces that were moved.
    triangles : int
        Faces of all charts.
    pages : int
        Square pages of a texture.
    resolution : int
        Texels to the side of a page.
    texels_per_unit : float
        Of the surface, or without positions of the UVs that were packed.
    utilisation : float
        Area of the UVs over that of the pages.
    margin : float
        Texels: the least of the distances of two charts and of twice those to the edges of pages,
        in the numbers that are delivered.
    seconds : float
        Wall time of the call.
    cpu_seconds : float
        Of the whole process during the call.
    splits : int
        Charts that were made two of, with the option fill-weight.
    split_length : float
        Of the seams of those, in roots of the surface's area.
    unsplit_utilisation : float
        Utilisation without splits; the same where there are none.
    """

    charts: int
    triangles: int
    pages: int
    resolution: int
    texels_per_unit: float
    utilisation: float
    margin: float
    seconds: float
    cpu_seconds: float
    splits: int
    split_length: float
    unsplit_utilisation: float
