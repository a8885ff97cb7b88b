"""Packing: the charts of any UVs onto the pages of a texture."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _arrays
from ._arrays import Array
from ._atlas import Atlas, tile_of
from ._cancel import CancelToken
from ._errors import NotInjectiveWarning
from ._library import PACK, Hook
from ._progress import Progress, hook_for
from ._tables import AtlasCertificate, PackingReport, PackOptions, PackTurnsChoice
from ._uv_meshes import PackContext, UvArrays

# call: pack


@dataclass(frozen=True, eq=False)
class UvMesh:
    """Triangles in the plane, to be packed. Triangles that share a UV vertex are of one chart.

    Attributes
    ----------
    uvs : (k, 2) array_like of floats
        One (u, v) per UV vertex.
    uv_faces : (m, 3) array_like of integers
        The UV vertices of each triangle.
    vertices : (n, 3) array_like of floats, optional
        Positions in space: with them charts get equally many texels for equal areas, else they keep
        their sizes to each other. All meshes have them, or none.
    faces : (m, 3) array_like of integers, optional
        The vertices of each triangle; left out where UV vertices are vertices.
    kept_pages : (m,) array_like of integers, optional
        -1 where the chart of a face is placed anew; else the page on which it stays where it is, in
        the unit square. The same for all faces of a chart.
    page_labels : (m,) array_like of integers, optional
        Charts of faces with different labels get different pages, in the order of the labels. A
        chart has the label of its first face. All meshes have them, or none, and none has
        `kept_pages`.

    Examples
    --------
    >>> uvs = [[0.0, 0], [1, 0], [0, 1], [5, 0], [6, 0], [5, 1]]
    >>> mesh = beltrami.UvMesh(uvs, [[0, 1, 2], [3, 4, 5]])
    >>> beltrami.pack(mesh).report.charts
    2
    """

    uvs: npt.ArrayLike
    uv_faces: npt.ArrayLike
    vertices: npt.ArrayLike | None = None
    faces: npt.ArrayLike | None = None
    kept_pages: npt.ArrayLike | None = None
    page_labels: npt.ArrayLike | None = None

    def arrays(self) -> UvArrays:
        """Return the arrays as the library reads them. Raises TypeError, ValueError."""
        return UvArrays(
            _arrays.coordinates(self.uvs),
            _arrays.indices(self.uv_faces),
            None if self.vertices is None else _arrays.positions(self.vertices),
            None if self.faces is None else _arrays.indices(self.faces),
            self._of_faces("kept_pages"),
            self._of_faces("page_labels"),
        )

    def _of_faces(self, name: str) -> Array | None:
        """Return integers that are given for each face, or None."""
        given = getattr(self, name)
        if given is None:
            return None
        numbers = np.ascontiguousarray(given, np.int64)
        if numbers.shape != (len(np.asarray(self.uv_faces)),):
            raise ValueError(f"{name} has the shape {numbers.shape}: give one for each face")
        return numbers


@dataclass(frozen=True, eq=False)
class Packing:
    """Charts on the pages of a texture. It equals itself only: compare what it holds.

    Attributes
    ----------
    uvs : tuple of (k, 2) arrays of float32 or float64
        For each mesh one (u, v) per UV vertex, in the unit square of its page; (0, 0) for those
        that no face uses.
    chart_of_face : tuple of (m,) arrays of int64
        For each mesh the chart of each face: charts count through all meshes, by their first faces.
    page_of_chart : (c,) array of int64
        The page of each chart.
    page_utilisations : (p,) array of float64
        The share of each page that charts cover.
    status : str
        "BELTRAMI_OK"; "BELTRAMI_NOT_INJECTIVE" where charts came folded, flipped or on themselves,
        or "BELTRAMI_NOT_INJECTIVE_FLOAT32".
    certificate : AtlasCertificate
        The exact verdict on the very numbers in `uvs`, page by page.
    float32_certificate : AtlasCertificate
        The same on the numbers rounded to float32.
    report : PackingReport
        Counts, density, margin and cost.
    options : PackOptions
        The options that were used, by keyword.
    masks : tuple of (r, r) arrays of uint8
        Where asked for, for each page a number for each texel, rows from the top: 0 free, 1 a
        gutter, 2 covered by a chart.
    uv_faces : tuple of (m, 3) arrays of integers
        For each mesh the UV vertices of each triangle, as they were given.
    """

    uvs: tuple[Array, ...] = field(repr=False)
    chart_of_face: tuple[Array, ...] = field(repr=False)
    page_of_chart: Array = field(repr=False)
    page_utilisations: Array = field(repr=False)
    status: str
    certificate: AtlasCertificate = field(repr=False)
    float32_certificate: AtlasCertificate = field(repr=False)
    report: PackingReport
    options: PackOptions = field(repr=False)
    masks: tuple[Array, ...] = field(repr=False)
    uv_faces: tuple[Array, ...] = field(repr=False)

    @property
    def injective(self) -> bool:
        """Whether what lies on the pages is proven to be injective."""
        return self.certificate.injective

    @property
    def pages(self) -> int:
        """The number of pages."""
        return self.report.pages

    @property
    def utilisation(self) -> float:
        """The area of the UVs over that of the pages."""
        return self.report.utilisation

    @property
    def udim_uvs(self) -> tuple[Array, ...]:
        """The UVs of each mesh in the tiles of UDIM: page k is 1001 + k."""
        tiled = []
        for uvs, charts, faces in zip(self.uvs, self.chart_of_face, self.uv_faces):
            pages = np.zeros(len(uvs), np.int64)
            pages[faces] = self.page_of_chart[charts][:, None]
            tiled.append(uvs + tile_of(pages, uvs.dtype))
        return tuple(tiled)


def pack(
    meshes: UvMesh | Atlas | Sequence[UvMesh | Atlas],
    *,
    # options: parameters
    threads: int = 1,
    float32: bool = False,
    resolution: int = 1024,
    margin: float = 2.0,
    texels_per_unit: float = 0.0,
    max_pages: int = 0,
    pack_turns: PackTurnsChoice = "any",
    pack_block: int = 1,
    # end of options
    masks: bool = False,
    progress: Progress = None,
    cancel: CancelToken | None = None,
) -> Packing:
    """Pack the charts of one UV mesh or several onto the pages of a texture.

    Each chart is moved, turned and scaled, and none is mirrored. Between charts there are at least
    `margin` texels, half as many to the edges of a page, measured on the numbers that are returned.
    The same input gives the same bits, at any number of threads.

    Parameters
    ----------
    meshes : UvMesh, Atlas, or sequence of them
        What shares the pages. An atlas is packed by its UVs and vertices.
    masks : bool, default False
        True adds for each page which texels charts cover, and which are gutters.
    progress : bool or callable, optional
        As for `parameterize`.
    cancel : CancelToken, optional
        Ends the call from any thread.

    Options
    -------
    threads : int, default 1
        Threads to use, the calling one included; the result does not depend on it. A number from 1
        to 1,024.
    float32 : bool, default False
        True delivers UVs that single precision holds exactly, rounded so that the map stays
        injective.
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

    Returns
    -------
    Packing
        `uvs` are float32 where the UVs of all meshes are, or with the option `float32`; else
        float64. Charts that come folded, flipped or on themselves stay so: the result is returned
        with a `NotInjectiveWarning` then.

    Raises
    ------
    NoRoomError
        The charts do not fit onto the pages that the options allow.
    MeshError
        `IndexOutOfRangeError`, `NonFiniteError`, or a mesh without faces, with the face or vertex
        in `element`.
    TypeError, ValueError
        For arrays of other shapes or types, for options out of range, and for charts that cannot
        stay where they are.
    Cancelled
        By `cancel`, or because `progress` returned False.
    KeyboardInterrupt
        On Ctrl-C, in the main thread.
    OutOfMemoryError, InternalError
        As their names say.

    Examples
    --------
    >>> uvs = [[0.0, 0], [1, 0], [0, 1], [5, 0], [6, 0], [5, 1]]  # of UV vertices
    >>> mesh = beltrami.UvMesh(uvs, [[0, 1, 2], [3, 4, 5]])
    >>> packing = beltrami.pack([mesh, mesh], resolution=256, margin=4)
    >>> packing.pages, packing.report.charts, packing.injective, packing.report.margin >= 4
    (1, 4, True, True)
    """
    given: dict[str, object] = {
        # options: items
        "threads": threads,
        "float32": float32,
        "resolution": resolution,
        "margin": margin,
        "texels_per_unit": texels_per_unit,
        "max_pages": max_pages,
        "pack_turns": pack_turns,
        "pack_block": pack_block,
        # end of options
    }
    listed = [meshes] if isinstance(meshes, (UvMesh, Atlas)) else list(meshes)
    with hook_for(progress) as hook:
        packing = packed(listed, given, masks, hook, cancel)
    if not packing.injective:
        found = packing.certificate
        warnings.warn(
            f"the packing is not injective: {found.negative} flipped triangles, "
            f"{found.degenerate} without area, {found.overlaps} overlaps",
            NotInjectiveWarning,
            stacklevel=2,
        )
    return packing


def _uv_mesh(mesh: Any) -> UvMesh:
    if isinstance(mesh, UvMesh):
        return mesh
    if not isinstance(mesh, Atlas):
        raise TypeError(f"pack takes UvMesh and Atlas, not {type(mesh).__name__}")
    return UvMesh(mesh.uvs, mesh.uv_triangles, mesh.vertices[mesh.origins])


def packed(
    things: Sequence[UvMesh | Atlas],
    given: dict[str, object],
    masks: bool,
    hook: Hook,
    cancel: CancelToken | None = None,
) -> Packing:
    """Pack with these options, and without a warning."""
    meshes: list[UvArrays] = [_uv_mesh(thing).arrays() for thing in things]
    context = PackContext(cancel)
    single = all(mesh.uvs.dtype == np.float32 for mesh in meshes)
    if single and given["float32"] is False:
        given = {**given, "float32": True}  # so that what is handed out is injective
    options = context.set_options(given, PACK)
    status = context.pack(meshes, hook)
    report = context.packing()
    dtype = np.dtype(np.float32 if options["float32"] else np.float64)
    pages = range(report.pages if masks else 0)
    return Packing(
        uvs=tuple(context.packed_uvs(i, mesh.uvs, dtype) for i, mesh in enumerate(meshes)),
        chart_of_face=tuple(
            context.packed_charts(i, len(mesh.uv_faces)) for i, mesh in enumerate(meshes)
        ),
        page_of_chart=context.chart_pages(report.charts),
        page_utilisations=context.page_utilisations(report.pages),
        status=status,
        certificate=context.packing_certificate(dtype),
        float32_certificate=context.packing_certificate(np.dtype(np.float32)),
        report=report,
        options=PackOptions(**options),  # type: ignore[typeddict-item]
        masks=tuple(context.page_mask(page, report.resolution) for page in pages),
        uv_faces=tuple(mesh.uv_faces for mesh in meshes),
    )
