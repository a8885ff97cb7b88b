"""Many meshes in one go, each unwrapped by a process of its own."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import Any

from . import _jobs, _library
from ._cancel import CancelToken
from ._jobs import BatchRecord
from ._progress import Progress
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
    WeldChoice,
)

# call: unwrap


def unwrap_batch(
    paths: Iterable[str | os.PathLike[str]],
    out_dir: str | os.PathLike[str],
    scheduler: Any = None,
    *,
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
    labels: str | None = None,
    triangulate: bool = False,
    suffix: str | None = None,
    root: str | os.PathLike[str] | None = None,
    jobs: int | None = None,
    progress: Progress = None,
    cancel: CancelToken | None = None,
) -> list[BatchRecord]:
    """Unwrap many mesh files, on all cores or on a Dask cluster; a second call resumes.

    Every mesh is a process of its own: one that fails, crashes or is killed becomes a record with
    its failure, and the others go on. ``out_dir/batch.jsonl`` gets a line for each when it ends. A
    mesh is left out where that log has a result for it, or its refusal. The file (by path, size and
    time), the options and the version of the library have to be the same. Whatever crashed, was
    cancelled, or could not be read or written is tried again. One call at a time may use a folder.

    Parameters
    ----------
    paths : iterable of path
        Meshes in OBJ, OFF, PLY, STL or glTF files.
    out_dir : path
        Folder for the results, which is made if need be: files with UVs, named as the meshes.
    scheduler : str or distributed.Client, optional
        Address of a Dask scheduler, such as "tcp://host:8786", or a client of one. The jobs run on
        its workers, which need this version of the package and the same paths. There is one on each
        of their threads: with `threads` above 1, have as many fewer of those. Left out, they run as
        processes on this machine.
    labels : str, optional
        Cut where these differ: "materials", "groups" or "objects" of an OBJ file, or the name of a
        property of the faces of a PLY file, "material" of glTF.
    triangulate : bool
        True writes the triangles that were computed on; False keeps polygons.
    suffix : {".obj", ".ply", ".gltf", ".glb"}, optional
        Format of the results; the latter two of glTF files only. Left out, that of each mesh, or
        OBJ where there is no writing it.
    root : path, optional
        Folder above the meshes: results keep their path below it. Left out, all results lie in
        `out_dir` itself.
    jobs : int, optional
        Processes at a time on this machine; left out, as many as there are cores for `threads`.
    progress : bool or callable, optional
        As for `parameterize`; called when a mesh is done, with the fraction that is done and the
        mesh's path. Returning False ends the batch.
    cancel : CancelToken, optional
        Ends the batch from any thread; on a cluster once the next job is done.

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
    list of BatchRecord
        One for each path, in their order; failures are those that are not `ok`.

    Raises
    ------
    TypeError, ValueError
        For options as `unwrap` does; where two results would have the same name, or one would
        replace a mesh; for a mesh that is not below `root`.
    OSError
        Where the folder or the log cannot be written, or the scheduler not be reached.
    ImportError
        With a scheduler, but without Dask.
    Cancelled, KeyboardInterrupt
        Jobs under way are ended (on a cluster, only those that have not begun); another call
        resumes.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> folder = pathlib.Path(tempfile.mkdtemp())
    >>> lines = "v 0 0 0", "v 1 0 0", "v 0 1 0", "v 0 0 1", "f 1 2 4", "f 2 3 4", "f 3 1 4"
    >>> _ = (folder / "tent.obj").write_text(chr(10).join(lines))
    >>> records = beltrami.unwrap_batch(folder.glob("*.obj"), folder / "unwrapped", margin=4)
    >>> [(record.output, record.status, record.injective) for record in records]
    [('tent.obj', 'BELTRAMI_OK', True)]
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
    options = _library.Context().set_options(given, _library.UNWRAP)
    arguments = _library.arguments(options)
    if labels is not None:
        arguments += ["--labels", labels]
    if triangulate:
        arguments += ["--triangulate"]
    depends = {**options, "labels": labels, "triangulate": triangulate}
    task = _jobs.Task("unwrap", arguments, depends, threads, (".obj", ".ply", ".gltf", ".glb"))
    return _jobs.run_batch(
        task,
        paths,
        out_dir,
        scheduler,
        suffix=suffix,
        root=root,
        jobs=jobs,
        progress=progress,
        cancel=cancel,
    )
