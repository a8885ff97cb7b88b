"""Unwrapping: any surface in, an atlas out."""

from __future__ import annotations

import os
import warnings
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, overload

import numpy as np
import numpy.typing as npt

from . import _hints, _sharing, _trimesh
from ._atlas import Atlas, SceneAtlases
from ._cancel import CancelToken
from ._errors import BeltramiError, NotInjectiveWarning
from ._given import require_arrays, surface_of, with_hints, with_straight
from ._library import UNWRAP, Hook, refuse
from ._polygons import Faces
from ._progress import Progress, hook_for
from ._surfaces import AtlasContext, Surface
from ._tables import (
    CutChoice,
    EffortChoice,
    EnergyChoice,
    FlattenChoice,
    InjectivityChoice,
    MethodChoice,
    PackChoice,
    PackTurnsChoice,
    PresetChoice,
    RectifyChoice,
    StackChoice,
    UnwrapOptions,
    WeldChoice,
)

if TYPE_CHECKING:
    from typing_extensions import Unpack

# call: unwrap

_SHARE_OF_MESHES = 0.9  # of the progress of a scene; the rest packs them onto common pages


@overload
def unwrap(
    vertices: npt.ArrayLike,
    faces: Faces,
    *,
    corner_uvs: npt.ArrayLike | None = None,
    face_labels: npt.ArrayLike | None = None,
    densities: npt.ArrayLike | None = None,
    seams: npt.ArrayLike | None = None,
    pins: tuple[npt.ArrayLike, ...] | None = None,
    straight: tuple[npt.ArrayLike, Sequence[str] | str] | None = None,
    rectangles: npt.ArrayLike | tuple[npt.ArrayLike, npt.ArrayLike] | None = None,
    vertex_paint: npt.ArrayLike | None = None,
    edge_paint: tuple[npt.ArrayLike, npt.ArrayLike] | None = None,
    materials: npt.ArrayLike | None = None,
    progress: Progress = None,
    cancel: CancelToken | None = None,
    **options: Unpack[UnwrapOptions],
) -> Atlas: ...
@overload
def unwrap(
    vertices: Any,
    faces: None = None,
    *,
    corner_uvs: npt.ArrayLike | None = None,
    face_labels: npt.ArrayLike | None = None,
    densities: npt.ArrayLike | None = None,
    seams: npt.ArrayLike | None = None,
    pins: tuple[npt.ArrayLike, ...] | None = None,
    straight: tuple[npt.ArrayLike, Sequence[str] | str] | None = None,
    rectangles: npt.ArrayLike | tuple[npt.ArrayLike, npt.ArrayLike] | None = None,
    vertex_paint: npt.ArrayLike | None = None,
    edge_paint: tuple[npt.ArrayLike, npt.ArrayLike] | None = None,
    materials: npt.ArrayLike | None = None,
    share_page: bool = False,
    progress: Progress = None,
    cancel: CancelToken | None = None,
    **options: Unpack[UnwrapOptions],
) -> Any: ...
def unwrap(
    vertices: Any,
    faces: Any = None,
    *,
    corner_uvs: npt.ArrayLike | None = None,
    face_labels: npt.ArrayLike | None = None,
    densities: npt.ArrayLike | None = None,
    seams: npt.ArrayLike | None = None,
    pins: tuple[npt.ArrayLike, ...] | None = None,
    straight: tuple[npt.ArrayLike, Sequence[str] | str] | None = None,
    rectangles: npt.ArrayLike | tuple[npt.ArrayLike, npt.ArrayLike] | None = None,
    vertex_paint: npt.ArrayLike | None = None,
    edge_paint: tuple[npt.ArrayLike, npt.ArrayLike] | None = None,
    materials: npt.ArrayLike | None = None,
    # options: parameters
    method: MethodChoice = "beltrami",
    energy: EnergyChoice = "symmetric-dirichlet",
    coarse_faces: int = 0,
    tolerance: float = 0.0001,
    max_iterations: int = 500,
    threads: int = 1,
    unit_square: bool = False,
    flatten: FlattenChoice = "metric",
    injectivity: InjectivityChoice = "auto",
    refine: bool = False,
    refine_iterations: int = 0,
    time_limit: float = 0.0,
    float32: bool = False,
    memory_limit: int = 0,
    cut: CutChoice = "auto",
    hard_angle: float = 180.0,
    weld: WeldChoice = "auto",
    weld_distance: float = 0.0,
    fill_holes: float = 0.5,
    share_copies: bool = False,
    preset: PresetChoice = "none",
    target_energy: float | None = None,
    target_p99: float = 0.0,
    max_charts: int | None = None,
    seam_budget: float = 0.0,
    concave_seams: float | None = None,
    hidden_seams: float | None = None,
    hard_seams: float | None = None,
    material_seams: float = 0.5,
    pack: PackChoice = "pages",
    resolution: int = 1024,
    margin: float = 2.0,
    texels_per_unit: float = 0.0,
    max_pages: int = 0,
    pack_turns: PackTurnsChoice = "any",
    pack_block: int = 1,
    fill_weight: float = 10.0,
    symmetric_seams: float = 0.0,
    straight_seams: float = 0.0,
    effort: EffortChoice = "normal",
    flat_seams: float | None = None,
    stack: StackChoice = "none",
    rectify: RectifyChoice = "none",
    snap_texels: bool = False,
    label_pages: bool = False,
    # end of options
    share_page: bool = False,
    progress: Progress = None,
    cancel: CancelToken | None = None,
) -> Any:
    """Cut any surface into charts and flatten them: an injective atlas, with low distortion.

    The surface may be closed or open, in any number of components, with holes and handles, and of
    any quality. Nothing is refused but indices out of range, numbers that are not finite, and
    surfaces without any area. What is not manifold is parted, faces that disagree are turned, and
    every corner gets its UV. The same input gives the same bits, at any number of threads.

    Name your distortion, and the seams follow: short ones are searched for, along which the atlas
    has the mean energy `target_energy`; ``atlas.report.reached`` tells whether it does. What they
    are is in ``atlas.seams``, to be edited and given back:
    ``unwrap(vertices, faces, seams=edited, cut="given")``.

    Parameters
    ----------
    vertices : (n, 3) array_like of floats, trimesh.Trimesh, trimesh.Scene, or path
        Positions in any unit of length. float32 and float64 with consecutive coordinates, and any
        positive distance from row to row, are read in place; all else is converted. A path is that
        of a file that trimesh loads.
    faces : (m, k) array_like of integers, or sequence of polygons
        Vertex numbers from 0: rows of 3 or more, or a sequence of polygons of any sizes. Left out
        with a mesh, a scene or a path. Triangles of int32, int64, uint32 and uint64 are read in
        place. Polygons are cut into triangles for the computation, and by no seam.
    corner_uvs : (m, k, 2) array_like of floats, optional
        UVs of the corners of each face, or (c, 2) of all corners: with ``cut="islands"`` seams run
        where they part. Of a mesh of trimesh its own are taken.
    face_labels : (m,) array_like, optional
        Materials, groups: numbers or words; seams run where they differ.
    densities : (m,) array_like of floats, optional
        Above 0: how much larger a face is to be in the plane. A chart has the mean of its faces.
    seams : (k, 2) array_like of integers, optional
        Edges to cut, by their vertices; pairs that are no edge are ignored.
    pins : tuple of (k,) array_like of integers and (k, 2) array_like of floats, optional
        Corners to hold, counted from 0 face after face, and the UVs that they get, to the bit: a
        chart takes the scale of its pins. Raises `PinError`, with the corner, where no injective
        map meets them. A third item has their kinds: ``"point"``, or ``"u"``, ``"v"`` or
        ``"line"`` for one that slides with that held; a fourth, (k, 2), the directions of lines.
    straight : tuple of (k, 2) array_like of integers and sequence of str, optional
        Edges, by their vertices, that become straight with those of their kind that they meet, in
        each chart that has them: ``"u"`` at one u, ``"v"`` at one v, ``"line"`` anywhere. One word
        stands for all. Raises `PinError` where no injective map has them so.
    rectangles : (k,) array_like of integers, optional
        Faces whose charts become rectangles along the axes: grids where they are rows and columns
        of quads, else with the four clear corners of their borders. A tuple names the corners as
        well: (k, 4) vertices. Raises `PinError`, with the face, where that cannot be.
    vertex_paint : (n,) array_like of floats, optional
        With ``cut="auto"`` factors of what a seam costs at each vertex, finite and at least 0: less
        than 1 draws seams, more drives them off, and nothing is forced. They count from 0.05 to 20,
        and an edge has the geometric mean of its ends.
    edge_paint : tuple of (k, 2) array_like of integers and (k,) array_like of floats, optional
        The same for edges, by their vertices: factors that multiply those of their ends.
    materials : (m,) array_like, optional
        With ``cut="auto"`` numbers or words: seams are drawn to where they differ, and cost
        `material_seams` of their length there.
    share_page : bool, default False
        Of a scene: True packs all of its meshes onto the same pages, instead of a page for each.
        Equal areas of the scene get equally many texels: of a mesh at several places, where it is
        largest. Not with ``pack="none"``, `fill_weight`, `stack` or `share_copies`. One mesh has
        the pages to itself in any case.
    progress : bool or callable, optional
        As for `parameterize`.
    cancel : CancelToken, optional
        Ends the call from any thread.

    Options
    -------
    method : {"beltrami", "cm", "tutte", "gif", "bff", "uv-prolongation"}, default "beltrami"
        How the map is computed: beltrami (fast and low in distortion), cm (composite majorization
        on the full mesh, the slow reference) or tutte (into a circle, highly distorted). Baselines
        to compare with are gif and bff on the surface's own metric, and uv-prolongation of the
        coarse UVs; bff and uv-prolongation may flip.
    energy : str, default "symmetric-dirichlet"
        One of "symmetric-dirichlet", "symmetric-arap", "exponential-dirichlet". The distortion that
        is minimised; exponential-dirichlet lowers it where it is highest, at a mean that is a
        little higher.
    coarse_faces : int, default 0
        Faces of the simplified mesh that composite majorization runs on. 0 chooses 1% of the faces,
        at least 10,000; or 1,000 to 5,000 where meshes from 4,000 faces on go through levels. A
        number from 0 to 700,000,000.
    tolerance : float, default 0.0001
        Relative decrease of the energy in one iteration below which composite majorization stops. A
        number from 0 to 1.
    max_iterations : int, default 500
        Iterations after which composite majorization stops even if it has not converged. A number
        from 1 to 1,000,000.
    threads : int, default 1
        Threads to use, the calling one included; the result does not depend on it. A number from 1
        to 1,024.
    unit_square : bool, default False
        True scales and shifts the UVs into the unit square, where those of pages are in any case;
        False keeps them in the mesh's unit of length.
    flatten : {"metric", "dirichlet", "gif", "flim", "bff"}, default "metric"
        How the method beltrami flattens the fine mesh. metric: a Poisson solve with a free
        boundary, and a polish. dirichlet: harmonic, boundary from the coarse map, faster, energy a
        little higher. gif: a harmonic subspace of a few boundary vertices with a scaffold. flim:
        the same, local injectivity only. bff: conformal, may flip.
    injectivity : {"auto", "global", "local"}, default "auto"
        What the optimisation sees to: global (no flips, no boundary crossings), local (no flips:
        parts may overlap, at a slightly lower energy) or auto. That is global, but for the method
        cm, which is left as the literature has it.
    refine : bool, default False
        True goes on with composite majorization on the fine mesh from the result, to a little less
        energy in much more time.
    refine_iterations : int, default 0
        Iterations after which the refinement stops; 0 leaves it to the tolerance. A number from 0
        to 1,000,000.
    time_limit : float, default 0.0
        Seconds since the start of the run after which iterations stop with the best map so far; 0
        sets no limit. A number from 0 to 1,000,000,000.
    float32 : bool, default False
        True delivers UVs that single precision holds exactly, rounded so that the map stays
        injective.
    memory_limit : int, default 0
        Bytes of memory that a run is to stay within by its estimate; 0 sets no limit. A run that
        needs more ends before it starts. Steps that only hard meshes need are left out where they
        would exceed it, or end the run if there is no map without them. A number from 0 to 1e+14.
    cut : {"minimal", "islands", "auto", "given"}, default "auto"
        Where seams go beside those that are given. auto: short ones are searched for, along which
        the atlas has the target-energy. minimal: a short cut graph where a piece is no disk.
        islands: around the charts of the UVs that the mesh has, of which what is no disk is opened.
        given: nowhere, and what is no disk is opened as by minimal.
    hard_angle : float, default 180.0
        Degrees between the normals of two faces above which the edge between them is a seam, but
        for creases that end within the surface and part nothing; 180 makes none. A number from 0 to
        180.
    weld : {"auto", "on", "off"}, default "auto"
        Whether vertices at one place, to the last bit, count as one: auto (yes, but a mesh that is
        one disk as it stands stays so), on or off.
    weld_distance : float, default 0.0
        Vertices no further apart, in the mesh's unit of length, count as one; 0 those at one place.
        A number from 0 to 1e+100.
    fill_holes : float, default 0.5
        Holes whose boundary is no longer than this many roots of their component's area cost no
        seam, larger ones are joined to one; 0 joins all. The longest of a component is its outline.
        A number from 0 to 1,000,000,000.
    share_copies : bool, default False
        True gives copies of a face, as of double-sided surfaces, the UVs of the first instead of a
        layer of their own.
    preset : {"none", "lightmap", "texturing", "one-chart", "hard-surface"}, default "none"
        What the seams are for: sets options of the search that are not set otherwise. none: their
        defaults. lightmap: target-energy 2.1, hidden-seams 0, hard-seams 0.5, flat-seams 2.
        texturing: concave-seams 0.6, hidden-seams 2. one-chart: max-charts 1. hard-surface:
        hard-seams 0.5, flat-seams 6.
    target_energy : float, default 2.05, or as the preset has it
        Mean symmetric Dirichlet energy of the atlas that seams are searched for, 2 for lengths that
        all stay: the nearer to 2, the longer the seams. A number from 2.0001 to 1,000,000,000.
    target_p99 : float, default 0.0
        Energy that no more than 1% of the area is to exceed; 0 leaves it to the mean. A number from
        0 to 1,000,000,000.
    max_charts : int, default 0, or as the preset has it
        Charts that the search is to stay within, or one for each component where there are more of
        these, if there is a way; 0 takes any number. A number from 0 to 1,000,000,000.
    seam_budget : float, default 0.0
        Length of the seams, over the root of the area, that the search is to stay within; 0 takes
        any length. A number from 0 to 1,000,000,000.
    concave_seams : float, default 0.15, or as the preset has it
        How far seams seek concave edges and avoid convex ones; 0 does not tell them apart. At a
        weight a one costs exp(-a c) of its length, where c goes from -1, convex, to 1, concave. A
        number from 0 to 10.
    hidden_seams : float, default 0.2, or as the preset has it
        How far seams hide; 0: not at all. At a weight b a seam costs 1 + b v times its length,
        where v goes from 0, seen from nowhere, to 1, seen from all sides. A number from 0 to 100.
    hard_seams : float, default 0.85, or as the preset has it
        What a seam costs, times its length, along an edge whose faces turn by more than 60 degrees:
        below 1 such edges are sought. A number from 0.01 to 100.
    material_seams : float, default 0.5
        What a seam costs, times its length, along an edge between faces of different materials,
        where these are given: below 1 such edges are sought. A number from 0.01 to 100.
    pack : {"pages", "none"}, default "pages"
        Where charts lie: pages (on square pages of a texture, all at one scale, UVs in the unit
        square) or none (side by side, in the mesh's unit of length). Charts with pins always lie as
        for none.
    resolution : int, default 1024
        Texels to the side of a page. A number from 8 to 32,768.
    margin : float, default 2.0
        Texels between two charts at least, and half as many to the edges of a page. A number from 0
        to 1,024.
    texels_per_unit : float, default 0.0
        Texels for a unit of length of the surface; 0 makes charts as large as they fit into
        max-pages. A number from 0 to 1e+30.
    max_pages : int, default 0
        Pages to fill at most; 0 takes one, or with texels-per-unit as many as there have to be. A
        number from 0 to 1,000.
    pack_turns : {"any", "quarter", "none"}, default "any"
        How charts may be turned on their page: any (as it fits best), quarter (their least box
        along the texels) or none; they are never mirrored.
    pack_block : int, default 1
        Texels to the side of the blocks that no two charts share, as compressed textures want it:
        4; 1 leaves it to the margin. A number from 1 to 64.
    fill_weight : float, default 10.0
        Length of seams, in roots of the area, that all of a page is worth to the search for seams;
        0 splits no chart. At 10 a chart is split in two where a tenth of the root of the area lets
        a hundredth more of the pages be filled. Charts of fewer than 32 triangles and those without
        a seam stay whole. A number from 0 to 1,000,000,000.
    symmetric_seams : float, default 0.0
        How much more seams may cost for being symmetric where the surface is: 0.5 for half as much
        again. They lie in the plane that it is mirrored by, or come in pairs, to within a few
        edges; 0 does not look for one. A number from 0 to 100.
    straight_seams : float, default 0.0
        How far seams avoid turns: at a weight w one by an angle t, in the surface, costs w (1 - cos
        t) times an edge there; 0 counts lengths alone. A number from 0 to 100.
    effort : {"quick", "normal", "high"}, default "normal"
        How long short seams are searched for, and a dense packing: quick, normal or high. quick
        takes half the time of normal, for seams some 2% longer. high takes some three times the
        time of normal, for seams some 2% shorter.
    flat_seams : float, default 1.5, or as the preset has it
        How many times as long the seams of a part may be if it then unfolds without distortion, as
        boxes and machined parts do along their edges. 0 spends all of target-energy. Setting that
        or target-p99 sets this to 0: set it after them. A number from 0 to 100.
    stack : {"none", "copies", "mirrored", "halves"}, default "none"
        Whether components of one shape share texels. none: no. copies: those that a rigid motion
        carries onto one before them lie on its charts. mirrored: mirror images do, too. halves:
        what is symmetric is cut along its plane, where edges lie in that, and one half lies on the
        other. Not with pins, max-charts, seam-budget or symmetric-seams.
    rectify : {"none", "grids"}, default "none"
        Which charts become rectangles along the axes: none, or grids. These are rows and columns of
        quads, as roads, tubes and cloths have: each column gets one width and each row one height.
    snap_texels : bool, default False
        True turns each chart to the most of its border that is straight, then by quarters alone,
        and moves straight borders onto the edges of texels. Lightmaps and pixel art want that.
        Nothing moves by more than half a texel, and charts keep a texel more room.
    label_pages : bool, default False
        True puts charts of faces with different labels on different pages, in the order of the
        labels, as tiles of UDIM by material. All have one density, and max-pages counts the pages
        of each label.

    Returns
    -------
    Atlas
        `uvs` are float32 where `vertices` are float32, or with the option `float32`, and rounded so
        that they stay injective; else float64. An atlas that is not injective is returned, too,
        with a `NotInjectiveWarning`; its `injective` is False, and its `charts` say which. Of a
        ``trimesh.Scene``, and of a file that trimesh loads as one, such as glTF, a `SceneAtlases`.
        Of files both have a `mesh`.

    Raises
    ------
    MeshError
        `IndexOutOfRangeError`, `NonFiniteError`, or a surface without faces or area, with the face
        or vertex in `element`; a scene without a mesh.
    TypeError, ValueError
        For arrays of other shapes or types, and for options out of range.
    Cancelled
        By `cancel`, or because `progress` returned False.
    KeyboardInterrupt
        On Ctrl-C, in the main thread.
    FileNotFoundError, IsADirectoryError
        For a path where there is no file.
    ImportError
        For a path, without trimesh.
    OutOfMemoryError, InternalError
        As their names say.

    Examples
    --------
    A tetrahedron, with a UV for each of its corners:

    >>> vertices = [[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
    >>> atlas = beltrami.unwrap(vertices, faces, margin=4, resolution=512)
    >>> atlas.corner_uvs.shape, atlas.injective, len(atlas.charts)
    ((4, 3, 2), True, 1)
    >>> positions, triangles, uvs = atlas.split()
    >>> positions.shape, triangles.shape, uvs.shape
    ((6, 3), (4, 3), (6, 2))
    """
    given: dict[str, object] = {
        # options: items
        "method": method,
        "energy": energy,
        "coarse_faces": coarse_faces,
        "tolerance": tolerance,
        "max_iterations": max_iterations,
        "threads": threads,
        "unit_square": unit_square,
        "flatten": flatten,
        "injectivity": injectivity,
        "refine": refine,
        "refine_iterations": refine_iterations,
        "time_limit": time_limit,
        "float32": float32,
        "memory_limit": memory_limit,
        "cut": cut,
        "hard_angle": hard_angle,
        "weld": weld,
        "weld_distance": weld_distance,
        "fill_holes": fill_holes,
        "share_copies": share_copies,
        "preset": preset,
        "target_energy": target_energy,
        "target_p99": target_p99,
        "max_charts": max_charts,
        "seam_budget": seam_budget,
        "concave_seams": concave_seams,
        "hidden_seams": hidden_seams,
        "hard_seams": hard_seams,
        "material_seams": material_seams,
        "pack": pack,
        "resolution": resolution,
        "margin": margin,
        "texels_per_unit": texels_per_unit,
        "max_pages": max_pages,
        "pack_turns": pack_turns,
        "pack_block": pack_block,
        "fill_weight": fill_weight,
        "symmetric_seams": symmetric_seams,
        "straight_seams": straight_seams,
        "effort": effort,
        "flat_seams": flat_seams,
        "stack": stack,
        "rectify": rectify,
        "snap_texels": snap_texels,
        "label_pages": label_pages,
        # end of options
    }
    if faces is not None:
        require_arrays(vertices, share_page)
    elif isinstance(vertices, (str, os.PathLike)):
        vertices = _trimesh.load(vertices)
    if faces is None and _trimesh.is_scene(vertices):
        of_cuts = (corner_uvs, face_labels, seams, vertex_paint, edge_paint, materials)
        of_faces = (*of_cuts, densities, pins, straight, rectangles)
        if any(values is not None for values in of_faces):
            raise TypeError("a scene has several meshes: give what belongs to faces with each mesh")
        return _unwrap_scene(vertices, given, share_page, progress, cancel)
    mesh = None
    if faces is None:
        if not _trimesh.is_mesh(vertices):
            instead = _hints.for_thing(vertices)
            missing = "faces are missing: only a mesh, a scene or a path brings its own"
            raise TypeError(missing if instead is None else f"vertices is {instead}")
        mesh, vertices, faces = vertices, vertices.vertices, vertices.faces
        if corner_uvs is None and cut == "islands":
            corner_uvs = _trimesh.corner_uvs(mesh)
    surface = surface_of(vertices, faces, corner_uvs, face_labels, densities, seams)
    surface = with_straight(surface, pins, straight, rectangles)
    surface = with_hints(surface, vertex_paint, edge_paint, materials)
    with hook_for(progress) as hook:
        atlas = _unwrap(surface, given, hook, cancel, mesh)
    _warn(atlas, "")
    return atlas


def _unwrap(
    surface: Surface,
    given: dict[str, object],
    hook: Hook,
    cancel: CancelToken | None,
    mesh: Any,
) -> Atlas:
    context = AtlasContext(cancel)
    single = surface.vertices.dtype == np.float32
    if single and given["float32"] is False:
        given = {**given, "float32": True}  # so that what is handed out is injective
    options = context.set_options(given, UNWRAP)
    if options["cut"] == "islands" and surface.corner_uvs is None:
        raise ValueError('cut="islands" keeps the charts of UVs: give them as corner_uvs')
    status = context.unwrap(surface, hook)
    faces, report = surface.faces, context.atlas()
    dtype = np.dtype(np.float32 if options["float32"] else np.float64)
    uvs = context.uv_vertices(report.uv_vertices, dtype)
    number = faces.indices.dtype
    uv_faces = faces.shaped(context.corner_uv_vertices(report.corners, number))
    origins = context.origins(report.uv_vertices, number)
    page_of_uv = np.zeros(report.uv_vertices, np.int64)
    if report.pages > 0:
        flat = np.concatenate(uv_faces) if isinstance(uv_faces, list) else uv_faces.ravel()
        page_of_uv[flat] = context.corner_pages(report.corners)
    return Atlas(
        uvs=uvs,
        uv_faces=uv_faces,
        origins=origins,
        seams=context.seams(report.seams, number),
        chart_of_face=context.face_charts(report.faces),
        charts=context.charts(report.charts),
        triangles=context.triangles(report.triangles),
        status=status,
        certificate=context.atlas_certificate(dtype),
        float32_certificate=context.atlas_certificate(np.dtype(np.float32)),
        report=report,
        stages=context.atlas_stages(),
        options=UnwrapOptions(**options),  # type: ignore[typeddict-item]
        vertices=surface.vertices,
        page_of_uv=page_of_uv,
        packing=context.packing() if report.pages > 0 else None,
        page_utilisations=context.page_utilisations(report.pages)
        if report.pages > 0
        else np.zeros(0),
        mesh=None if mesh is None else _trimesh.split(mesh, origins, uv_faces, uvs),
    )


def _unwrap_scene(
    scene: Any,
    given: dict[str, object],
    share_page: bool,
    progress: Progress,
    cancel: CancelToken | None,
) -> SceneAtlases:
    if share_page:
        pack_options, given = _sharing.options(given)
    meshes = {name: thing for name, thing in scene.geometry.items() if _trimesh.is_mesh(thing)}
    if not meshes:
        refuse("BELTRAMI_E_EMPTY", "the scene has no mesh: there is nothing to unwrap")
    total = max(1, sum(len(mesh.faces) for mesh in meshes.values()))
    before = 0.0
    atlases: dict[str, Atlas] = {}
    with hook_for(progress) as hook:
        for name, mesh in meshes.items():
            share = len(mesh.faces) / total * (_SHARE_OF_MESHES if share_page else 1)
            of_scene = _part_of(hook, before, share)
            uvs = _trimesh.corner_uvs(mesh) if given["cut"] == "islands" else None
            try:
                surface = surface_of(mesh.vertices, mesh.faces, uvs, None, None, None)
                atlases[name] = _unwrap(surface, given, of_scene, cancel, mesh)
            except BeltramiError as error:
                error.args = (f"{name}: {error}",)
                raise
            before += share
        if share_page:
            rest = _part_of(hook, before, 1 - before)
            atlases = _sharing.onto_common_pages(scene, atlases, meshes, pack_options, rest, cancel)
    for name, atlas in atlases.items():
        _warn(atlas, f"{name}: ", callers=3)
    textured = {name: atlas.mesh for name, atlas in atlases.items()}
    return SceneAtlases(_trimesh.with_meshes(scene, textured), atlases)


def _part_of(hook: Hook, before: float, share: float) -> Hook:
    """Return the hook of a part of a run, which is told fractions of the part."""
    return lambda fraction, stage: hook(min(1.0, before + share * fraction), stage)


def _warn(atlas: Atlas, where: str, callers: int = 2) -> None:
    """Warn of an atlas that is not injective; `callers` says how many calls up."""
    if atlas.injective:
        return
    found, failed = (
        atlas.certificate,
        [chart for chart in atlas.charts if chart.error != "BELTRAMI_OK"],
    )
    message = (
        f"{where}the atlas is not injective: {found.negative} flipped triangles, "
        f"{found.degenerate} without area, {found.overlaps} overlaps"
    )
    if failed:
        message += f"; {len(failed)} charts have no map, the first at face {failed[0].first_face}"
    warnings.warn(message, NotInjectiveWarning, stacklevel=callers + 1)
