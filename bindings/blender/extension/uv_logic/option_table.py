# SPDX-FileCopyrightText: 2026 The beltrami authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The options of the library, from its own table.

Written by ``tools/generate.py``: change it there.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Option:
    """An option of the library.

    Attributes
    ----------
    name : str
        Its keyword in the Python package.
    kind : {"bool", "int", "float", "choice"}
        What its values are.
    default : bool, int, float or str
        Of a choice its name.
    minimum, maximum : float
        The range of a number.
    choices : tuple of str
        The names of choices.
    summary : str
        What it does.
    unwraps, packs : bool
        Whether unwrapping, and packing, take it.
    of_presets : bool
        Whether the option ``preset`` sets it where it is not given.
    """

    name: str
    kind: str
    default: bool | int | float | str
    minimum: float
    maximum: float
    choices: tuple[str, ...]
    summary: str
    unwraps: bool
    packs: bool
    of_presets: bool


# Summaries stand as the library has them.
# ruff: noqa: E501
# fmt: off
OPTIONS = (
    Option(
        "method", "choice", "beltrami", 0.0, 5.0,
        ("beltrami", "cm", "tutte", "gif", "bff", "uv-prolongation"),
        "How the map is computed: beltrami (fast and low in distortion), cm (composite majorization on the full mesh, the slow reference) or tutte (into a circle, highly distorted). Baselines to compare with are gif and bff on the surface's own metric, and uv-prolongation of the coarse UVs; bff and uv-prolongation may flip.",
        True, False, False,
    ),
    Option(
        "energy", "choice", "symmetric-dirichlet", 0.0, 2.0,
        ("symmetric-dirichlet", "symmetric-arap", "exponential-dirichlet"),
        "The distortion that is minimised; exponential-dirichlet lowers it where it is highest, at a mean that is a little higher.",
        True, False, False,
    ),
    Option(
        "coarse_faces", "int", 0, 0.0, 700000000.0,
        (),
        "Faces of the simplified mesh that composite majorization runs on. 0 chooses 1% of the faces, at least 10,000; or 1,000 to 5,000 where meshes from 4,000 faces on go through levels.",
        True, False, False,
    ),
    Option(
        "tolerance", "float", 0.0001, 0.0, 1.0,
        (),
        "Relative decrease of the energy in one iteration below which composite majorization stops.",
        True, False, False,
    ),
    Option(
        "max_iterations", "int", 500, 1.0, 1000000.0,
        (),
        "Iterations after which composite majorization stops even if it has not converged.",
        True, False, False,
    ),
    Option(
        "threads", "int", 1, 1.0, 1024.0,
        (),
        "Threads to use, the calling one included; the result does not depend on it.",
        True, True, False,
    ),
    Option(
        "unit_square", "bool", False, 0.0, 1.0,
        (),
        "True scales and shifts the UVs into the unit square, where those of pages are in any case; False keeps them in the mesh's unit of length.",
        True, False, False,
    ),
    Option(
        "flatten", "choice", "metric", 0.0, 4.0,
        ("metric", "dirichlet", "gif", "flim", "bff"),
        "How the method beltrami flattens the fine mesh. metric: a Poisson solve with a free boundary, and a polish. dirichlet: harmonic, boundary from the coarse map, faster, energy a little higher. gif: a harmonic subspace of a few boundary vertices with a scaffold. flim: the same, local injectivity only. bff: conformal, may flip.",
        True, False, False,
    ),
    Option(
        "injectivity", "choice", "auto", 0.0, 2.0,
        ("auto", "global", "local"),
        "What the optimisation sees to: global (no flips, no boundary crossings), local (no flips: parts may overlap, at a slightly lower energy) or auto. That is global, but for the method cm, which is left as the literature has it.",
        True, False, False,
    ),
    Option(
        "refine", "bool", False, 0.0, 1.0,
        (),
        "True goes on with composite majorization on the fine mesh from the result, to a little less energy in much more time.",
        True, False, False,
    ),
    Option(
        "refine_iterations", "int", 0, 0.0, 1000000.0,
        (),
        "Iterations after which the refinement stops; 0 leaves it to the tolerance.",
        True, False, False,
    ),
    Option(
        "time_limit", "float", 0.0, 0.0, 1000000000.0,
        (),
        "Seconds since the start of the run after which iterations stop with the best map so far; 0 sets no limit.",
        True, False, False,
    ),
    Option(
        "float32", "bool", False, 0.0, 1.0,
        (),
        "True delivers UVs that single precision holds exactly, rounded so that the map stays injective.",
        True, True, False,
    ),
    Option(
        "memory_limit", "int", 0, 0.0, 100000000000000.0,
        (),
        "Bytes of memory that a run is to stay within by its estimate; 0 sets no limit. A run that needs more ends before it starts. Steps that only hard meshes need are left out where they would exceed it, or end the run if there is no map without them.",
        True, False, False,
    ),
    Option(
        "cut", "choice", "auto", 0.0, 3.0,
        ("minimal", "islands", "auto", "given"),
        "Where seams go beside those that are given. auto: short ones are searched for, along which the atlas has the target-energy. minimal: a short cut graph where a piece is no disk. islands: around the charts of the UVs that the mesh has, of which what is no disk is opened. given: nowhere, and what is no disk is opened as by minimal.",
        True, False, False,
    ),
    Option(
        "hard_angle", "float", 180.0, 0.0, 180.0,
        (),
        "Degrees between the normals of two faces above which the edge between them is a seam, but for creases that end within the surface and part nothing; 180 makes none.",
        True, False, False,
    ),
    Option(
        "weld", "choice", "auto", 0.0, 2.0,
        ("auto", "on", "off"),
        "Whether vertices at one place, to the last bit, count as one: auto (yes, but a mesh that is one disk as it stands stays so), on or off.",
        True, False, False,
    ),
    Option(
        "weld_distance", "float", 0.0, 0.0, 1e+100,
        (),
        "Vertices no further apart, in the mesh's unit of length, count as one; 0 those at one place.",
        True, False, False,
    ),
    Option(
        "fill_holes", "float", 0.5, 0.0, 1000000000.0,
        (),
        "Holes whose boundary is no longer than this many roots of their component's area cost no seam, larger ones are joined to one; 0 joins all. The longest of a component is its outline.",
        True, False, False,
    ),
    Option(
        "share_copies", "bool", False, 0.0, 1.0,
        (),
        "True gives copies of a face, as of double-sided surfaces, the UVs of the first instead of a layer of their own.",
        True, False, False,
    ),
    Option(
        "preset", "choice", "none", 0.0, 4.0,
        ("none", "lightmap", "texturing", "one-chart", "hard-surface"),
        "What the seams are for: sets options of the search that are not set otherwise. none: their defaults. lightmap: target-energy 2.1, hidden-seams 0, hard-seams 0.5, flat-seams 2. texturing: concave-seams 0.6, hidden-seams 2. one-chart: max-charts 1. hard-surface: hard-seams 0.5, flat-seams 6.",
        True, False, False,
    ),
    Option(
        "target_energy", "float", 2.05, 2.0001, 1000000000.0,
        (),
        "Mean symmetric Dirichlet energy of the atlas that seams are searched for, 2 for lengths that all stay: the nearer to 2, the longer the seams.",
        True, False, True,
    ),
    Option(
        "target_p99", "float", 0.0, 0.0, 1000000000.0,
        (),
        "Energy that no more than 1% of the area is to exceed; 0 leaves it to the mean.",
        True, False, False,
    ),
    Option(
        "max_charts", "int", 0, 0.0, 1000000000.0,
        (),
        "Charts that the search is to stay within, or one for each component where there are more of these, if there is a way; 0 takes any number.",
        True, False, True,
    ),
    Option(
        "seam_budget", "float", 0.0, 0.0, 1000000000.0,
        (),
        "Length of the seams, over the root of the area, that the search is to stay within; 0 takes any length.",
        True, False, False,
    ),
    Option(
        "concave_seams", "float", 0.15, 0.0, 10.0,
        (),
        "How far seams seek concave edges and avoid convex ones; 0 does not tell them apart. At a weight a one costs exp(-a c) of its length, where c goes from -1, convex, to 1, concave.",
        True, False, True,
    ),
    Option(
        "hidden_seams", "float", 0.2, 0.0, 100.0,
        (),
        "How far seams hide; 0: not at all. At a weight b a seam costs 1 + b v times its length, where v goes from 0, seen from nowhere, to 1, seen from all sides.",
        True, False, True,
    ),
    Option(
        "hard_seams", "float", 0.85, 0.01, 100.0,
        (),
        "What a seam costs, times its length, along an edge whose faces turn by more than 60 degrees: below 1 such edges are sought.",
        True, False, True,
    ),
    Option(
        "material_seams", "float", 0.5, 0.01, 100.0,
        (),
        "What a seam costs, times its length, along an edge between faces of different materials, where these are given: below 1 such edges are sought.",
        True, False, False,
    ),
    Option(
        "pack", "choice", "pages", 0.0, 1.0,
        ("pages", "none"),
        "Where charts lie: pages (on square pages of a texture, all at one scale, UVs in the unit square) or none (side by side, in the mesh's unit of length). Charts with pins always lie as for none.",
        True, False, False,
    ),
    Option(
        "resolution", "int", 1024, 8.0, 32768.0,
        (),
        "Texels to the side of a page.",
        True, True, False,
    ),
    Option(
        "margin", "float", 2.0, 0.0, 1024.0,
        (),
        "Texels between two charts at least, and half as many to the edges of a page.",
        True, True, False,
    ),
    Option(
        "texels_per_unit", "float", 0.0, 0.0, 1e+30,
        (),
        "Texels for a unit of length of the surface; 0 makes charts as large as they fit into max-pages.",
        True, True, False,
    ),
    Option(
        "max_pages", "int", 0, 0.0, 1000.0,
        (),
        "Pages to fill at most; 0 takes one, or with texels-per-unit as many as there have to be.",
        True, True, False,
    ),
    Option(
        "pack_turns", "choice", "any", 0.0, 2.0,
        ("any", "quarter", "none"),
        "How charts may be turned on their page: any (as it fits best), quarter (their least box along the texels) or none; they are never mirrored.",
        True, True, False,
    ),
    Option(
        "pack_block", "int", 1, 1.0, 64.0,
        (),
        "Texels to the side of the blocks that no two charts share, as compressed textures want it: 4; 1 leaves it to the margin.",
        True, True, False,
    ),
    Option(
        "fill_weight", "float", 10.0, 0.0, 1000000000.0,
        (),
        "Length of seams, in roots of the area, that all of a page is worth to the search for seams; 0 splits no chart. At 10 a chart is split in two where a tenth of the root of the area lets a hundredth more of the pages be filled. Charts of fewer than 32 triangles and those without a seam stay whole.",
        True, False, False,
    ),
    Option(
        "symmetric_seams", "float", 0.0, 0.0, 100.0,
        (),
        "How much more seams may cost for being symmetric where the surface is: 0.5 for half as much again. They lie in the plane that it is mirrored by, or come in pairs, to within a few edges; 0 does not look for one.",
        True, False, False,
    ),
    Option(
        "straight_seams", "float", 0.0, 0.0, 100.0,
        (),
        "How far seams avoid turns: at a weight w one by an angle t, in the surface, costs w (1 - cos t) times an edge there; 0 counts lengths alone.",
        True, False, False,
    ),
    Option(
        "effort", "choice", "normal", 0.0, 2.0,
        ("quick", "normal", "high"),
        "How long short seams are searched for, and a dense packing: quick, normal or high. quick takes half the time of normal, for seams some 2% longer. high takes some three times the time of normal, for seams some 2% shorter.",
        True, False, False,
    ),
    Option(
        "flat_seams", "float", 1.5, 0.0, 100.0,
        (),
        "How many times as long the seams of a part may be if it then unfolds without distortion, as boxes and machined parts do along their edges. 0 spends all of target-energy. Setting that or target-p99 sets this to 0: set it after them.",
        True, False, True,
    ),
    Option(
        "stack", "choice", "none", 0.0, 3.0,
        ("none", "copies", "mirrored", "halves"),
        "Whether components of one shape share texels. none: no. copies: those that a rigid motion carries onto one before them lie on its charts. mirrored: mirror images do, too. halves: what is symmetric is cut along its plane, where edges lie in that, and one half lies on the other. Not with pins, max-charts, seam-budget or symmetric-seams.",
        True, False, False,
    ),
    Option(
        "rectify", "choice", "none", 0.0, 1.0,
        ("none", "grids"),
        "Which charts become rectangles along the axes: none, or grids. These are rows and columns of quads, as roads, tubes and cloths have: each column gets one width and each row one height.",
        True, False, False,
    ),
    Option(
        "snap_texels", "bool", False, 0.0, 1.0,
        (),
        "True turns each chart to the most of its border that is straight, then by quarters alone, and moves straight borders onto the edges of texels. Lightmaps and pixel art want that. Nothing moves by more than half a texel, and charts keep a texel more room.",
        True, False, False,
    ),
    Option(
        "label_pages", "bool", False, 0.0, 1.0,
        (),
        "True puts charts of faces with different labels on different pages, in the order of the labels, as tiles of UDIM by material. All have one density, and max-pages counts the pages of each label.",
        True, False, False,
    ),
)
