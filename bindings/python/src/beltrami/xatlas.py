"""The interface of the package ``xatlas`` 0.0.11, with the atlases of beltrami.

>>> import beltrami.xatlas as xatlas
>>> positions = [[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]  # (n, 3) floats
>>> faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]  # (m, 3) integers
>>> vmapping, indices, uvs = xatlas.parametrize(positions, faces)
>>> vmapping[indices].tolist() == faces, indices.dtype.name, uvs.dtype.name
(True, 'uint32', 'float32')

Code that says ``import xatlas`` itself, such as ``trimesh.Trimesh.unwrap``, gets this module where
it is put in the place of that package first::

    import sys
    import beltrami.xatlas

    sys.modules["xatlas"] = beltrami.xatlas
    unwrapped = mesh.unwrap()  # a trimesh.Trimesh

Functions, classes, attributes, defaults, and the shapes and types of arrays are those of xatlas.
These are the differences:

- Seams are searched for at ``effort="quick"``, on all cores. Every keyword of `beltrami.unwrap` but
  those of pages may be given to `parametrize` and to `Atlas.generate`, such as ``effort="normal"``.
- Atlases are certified by exact predicates. One that is not injective comes with a
  `NotInjectiveWarning`.
- Pages are squares of exactly the resolution that is asked for, 1024 texels by default.
- The weights and limits of `ChartOptions` have no effect, nor have normals.
- Positions of float64 are used as they are, and not rounded to float32.
- A mesh without area, and numbers that are not finite, are refused with a `MeshError`.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _arrays, _library, _raster
from ._arrays import Array
from ._jobs import cores
from ._pack import Packing, UvMesh
from ._tables import UnwrapOptions
from ._xatlas_meshes import (
    SIDE,
    AddedMesh,
    AddedUvs,
    Made,
    Pages,
    colours,
    faces_of,
    made_of,
    packed_onto,
    shaped,
)
from ._xatlas_options import Chart, ChartOptions, ChartType, PackOptions

if TYPE_CHECKING:
    from typing_extensions import Unpack

__all__ = [
    "Atlas",
    "Chart",
    "ChartOptions",
    "ChartType",
    "PackOptions",
    "export",
    "parametrize",
]
__version__ = _library.version()

#: What `PackOptions` says, and not a keyword.
_OF_PAGES = {
    *("pack", "resolution", "margin", "texels_per_unit", "max_pages", "pack_turns", "pack_block"),
    *("fill_weight", "unit_square", "float32"),
}


class Atlas:
    """Meshes that share the pages of a texture: add them, `generate`, and get them back.

    >>> import beltrami.xatlas as xatlas
    >>> positions = [[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
    >>> atlas = xatlas.Atlas()
    >>> atlas.add_mesh(positions, faces)
    >>> atlas.add_mesh(positions, faces[:2])
    >>> atlas.generate()
    >>> len(atlas), atlas.atlas_count, (atlas.width, atlas.height)
    (2, 1, (1024, 1024))
    >>> vmapping, indices, uvs = atlas[1]
    >>> indices.shape, uvs.shape == (len(vmapping), 2)
    ((2, 3), True)
    """

    def __init__(self) -> None:
        self._meshes: list[AddedMesh | AddedUvs] = []
        self._made: list[Made] = []
        self._side = 0
        self._texels_per_unit = 0.0
        self._utilisations: Array = np.zeros(0)
        self._has_image = False

    def add_mesh(
        self,
        positions: npt.ArrayLike,
        indices: npt.ArrayLike,
        normals: npt.ArrayLike | None = None,
        uvs: npt.ArrayLike | None = None,
    ) -> None:
        """Add a mesh; `generate` unwraps it.

        Parameters
        ----------
        positions : (n, 3) array_like of floats
            In any unit of length.
        indices : (m, 3) array_like of integers
            Vertex numbers from 0.
        normals : (n, 3) array_like of floats, optional
            Without effect.
        uvs : (n, 2) array_like of floats, optional
            For `ChartOptions.use_input_mesh_uvs`.

        Raises
        ------
        IndexOutOfRangeError
            A `RuntimeError`: a face names a vertex that does not exist.
        TypeError, ValueError
            For arrays of other shapes or types.
        RuntimeError
            The atlas has meshes of UVs.
        """
        points = _arrays.positions(shaped("positions", positions, 3))
        faces = faces_of(indices, len(points))
        if normals is not None:
            shaped("normals", normals, 3, len(points))
        if uvs is not None:
            uvs = _arrays.coordinates(shaped("uvs", uvs, 2, len(points)))
        # The arrays are the caller's to fill anew before `generate`.
        self._add(AddedMesh(points.copy(), faces.copy(), None if uvs is None else uvs.copy()))

    def add_uv_mesh(
        self,
        uvs: npt.ArrayLike,
        indices: npt.ArrayLike,
        face_materials: npt.ArrayLike | None = None,
    ) -> None:
        """Add a mesh of UVs; `generate` packs its charts, and keeps their shapes and sizes.

        Parameters
        ----------
        uvs : (n, 2) array_like of floats
            One (u, v) per UV vertex. Triangles that share one are of one chart.
        indices : (m, 3) array_like of integers
            UV vertices of each triangle, from 0.
        face_materials : (m,) or (m, 1) array_like of integers, optional
            At least 0: a chart has faces of one material.

        Raises
        ------
        IndexOutOfRangeError
            A `RuntimeError`: a face names a vertex that does not exist.
        TypeError, ValueError
            For arrays of other shapes or types.
        RuntimeError
            The atlas has meshes with positions.
        """
        coordinates = _arrays.coordinates(shaped("uvs", uvs, 2))
        faces = faces_of(indices, len(coordinates))
        keys, materials = faces.astype(np.int64), None
        if face_materials is not None:
            materials = np.asarray(face_materials)
            if materials.shape not in [(len(faces),), (len(faces), 1)]:
                raise ValueError(
                    f"face_materials: an array of one for each of {len(faces)} faces, Nx1, is "
                    f"expected, not {materials.shape}"
                )
            if materials.dtype.kind not in "iu":
                raise TypeError(f"face_materials must be integers, not {materials.dtype}")
            materials = materials.ravel()
            groups = np.unique(materials, return_inverse=True)[1].reshape(-1, 1)
            keys = groups * len(coordinates) + keys
        used, local = np.unique(keys, return_inverse=True)
        vmapping = used % max(len(coordinates), 1)
        local = local.reshape(faces.shape)
        self._add(AddedUvs(coordinates[vmapping], local, vmapping, materials))

    def _add(self, mesh: AddedMesh | AddedUvs) -> None:
        if self._meshes and type(self._meshes[0]) is not type(mesh):
            raise RuntimeError("an atlas has meshes or UV meshes, not both")
        self._meshes.append(mesh)

    def generate(
        self,
        chart_options: ChartOptions | None = None,
        pack_options: PackOptions | None = None,
        verbose: bool = False,
        **options: Unpack[UnwrapOptions],
    ) -> None:
        """Unwrap all meshes and pack their charts onto common pages, at one scale.

        Parameters
        ----------
        chart_options : ChartOptions, optional
            Where seams go.
        pack_options : PackOptions, optional
            How charts lie on the pages.
        verbose : bool
            True prints the utilisation, the number of charts and the size of the pages.
        **options
            Keywords of `beltrami.unwrap`, but for those of pages: what xatlas does not have. Left
            out, `effort` is "quick" and `threads` the number of cores.

        Raises
        ------
        NoRoomError
            A chart does not fit onto a page at the `texels_per_unit` that is asked for.
        MeshError
            A mesh without faces or area, or with a position that is not finite.
        TypeError, ValueError
            For options that do not exist or are out of range.
        KeyboardInterrupt
            On Ctrl-C, in the main thread.
        """
        chart_options, pack_options = chart_options or ChartOptions(), pack_options or PackOptions()
        odd = sorted(_OF_PAGES & options.keys())
        if odd:
            raise TypeError(f"{odd[0]} is no option here: pages are what pack_options say")
        chosen: dict[str, Any] = {"effort": "quick", "threads": cores(), **options}
        pages = Pages.of(pack_options)
        if not self._meshes:
            self._made, self._side, self._utilisations = [], 0, np.zeros(0)
            return
        surfaces = [mesh for mesh in self._meshes if isinstance(mesh, AddedMesh)]
        uv_meshes = [mesh for mesh in self._meshes if isinstance(mesh, AddedUvs)]
        keep = bool(chart_options.use_input_mesh_uvs)
        if uv_meshes:
            self._pack_uv_meshes(uv_meshes, pages, chosen["threads"])
        elif len(surfaces) == 1 and not pages.measured:
            self._unwrap_one(surfaces[0], keep, pages, chosen)
        else:
            self._unwrap_all(surfaces, keep, pages, chosen)
        self._has_image = bool(pack_options.create_image)
        if verbose:
            print("--- Generated Atlas ---")
            print(f"Utilization: {100 * self.utilization:f}%")
            print(f"Charts: {self.chart_count}")
            print(f"Size: {self.width}x{self.height}\n")

    def _unwrap_one(
        self, mesh: AddedMesh, keep_uvs: bool, pages: Pages, options: dict[str, Any]
    ) -> None:
        atlas = mesh.unwrapped(
            keep_uvs,
            {
                **options,
                "resolution": pages.resolution or SIDE,
                "texels_per_unit": pages.texels_per_unit,
                "margin": pages.margin,
                "pack_turns": pages.turns,
                "pack_block": pages.block,
            },
        )
        packing = atlas.packing
        if packing is None:  # with pins; there are none
            raise AssertionError("the atlas is not packed")
        self._made = [made_of(atlas, atlas.uvs, np.array([chart.page for chart in atlas.charts]))]
        self._side = packing.resolution
        self._texels_per_unit = packing.texels_per_unit
        self._utilisations = atlas.page_utilisations

    def _unwrap_all(
        self, meshes: Sequence[AddedMesh], keep_uvs: bool, pages: Pages, options: dict[str, Any]
    ) -> None:
        atlases = [mesh.unwrapped(keep_uvs, {**options, "pack": "none"}) for mesh in meshes]
        packing = packed_onto(atlases, pages, options["threads"])
        made = []
        for atlas, uvs, packed in zip(atlases, packing.uvs, packing.chart_of_face):
            chart = atlas.chart_of_face[atlas.face_of_triangle]
            page = np.zeros(len(atlas.charts), np.int64)
            page[chart[chart >= 0]] = packing.page_of_chart[packed[chart >= 0]]
            made.append(made_of(atlas, uvs, page))
        self._keep(made, packing)

    def _pack_uv_meshes(self, meshes: Sequence[AddedUvs], pages: Pages, threads: int) -> None:
        packing = packed_onto([UvMesh(mesh.uvs, mesh.faces) for mesh in meshes], pages, threads)
        made = []
        for mesh, uvs, packed in zip(meshes, packing.uvs, packing.chart_of_face):
            charts, local = np.unique(packed, return_inverse=True)
            types = np.full(len(charts), ChartType.LSCM)
            page = packing.page_of_chart[charts]
            made.append(Made(mesh.vmapping, mesh.faces, uvs, local, page, types, mesh.materials))
        self._keep(made, packing)

    def _keep(self, made: list[Made], packing: Packing) -> None:
        self._made = made
        self._side = packing.report.resolution
        self._texels_per_unit = packing.report.texels_per_unit
        self._utilisations = packing.page_utilisations

    def get_mesh(self, mesh_index: int) -> tuple[Array, Array, Array]:
        """Return what became of a mesh.

        Parameters
        ----------
        mesh_index : int
            From 0, in the order in which meshes were added.

        Returns
        -------
        vmapping : (k,) array of uint32
            The vertex of the mesh that each new vertex is a copy of.
        indices : (m, 3) array of uint32
            The new vertices of the faces, which are those of the mesh in their order.
        uvs : (k, 2) array of float32
            One (u, v) per new vertex, in the unit square of its page.

        Raises
        ------
        IndexError
            There is no such mesh, or `generate` has not been called.
        """
        made = self._mesh(mesh_index)
        return (
            made.vmapping.astype(np.uint32),
            made.faces.astype(np.uint32),
            made.uvs.astype(np.float32),
        )

    def __getitem__(self, mesh_index: int) -> tuple[Array, Array, Array]:
        return self.get_mesh(mesh_index)

    def __len__(self) -> int:
        return self.mesh_count

    def _mesh(self, index: int) -> Made:
        if not 0 <= index < len(self._made):
            raise IndexError(
                f"mesh index {index} out of bounds for an atlas with {len(self._made)} meshes"
            )
        return self._made[index]

    def _page(self, index: int) -> int:
        if not 0 <= index < len(self._utilisations):
            raise IndexError(
                f"atlas index {index} out of bounds: there are {len(self._utilisations)} pages"
            )
        return index

    def get_mesh_vertex_assignment(self, mesh_index: int) -> tuple[Array, Array]:
        """Return the page and the chart of each new vertex, two (k,) arrays of uint32.

        Charts are counted through all meshes; both are 4294967295 for vertices of faces without
        area. Raises IndexError as `get_mesh` does.
        """
        made = self._mesh(mesh_index)
        first = sum(len(before.page_of_chart) for before in self._made[:mesh_index])
        return made.assignment(first)

    def get_mesh_chart_count(self, mesh_index: int) -> int:
        """Return the number of charts of a mesh. Raises IndexError as `get_mesh` does."""
        return len(self._mesh(mesh_index).page_of_chart)

    def get_mesh_chart(self, mesh_index: int, chart_index: int) -> Chart:
        """Return a chart of a mesh, both counted from 0. Raises IndexError where there is none."""
        made = self._mesh(mesh_index)
        if not 0 <= chart_index < len(made.page_of_chart):
            raise IndexError(
                f"chart index {chart_index} out of bounds for a mesh with "
                f"{len(made.page_of_chart)} charts"
            )
        faces = np.flatnonzero(made.chart_of_face == chart_index)
        return Chart(
            faces.astype(np.uint32),
            int(made.page_of_chart[chart_index]),
            ChartType(int(made.types[chart_index])),
            0 if made.materials is None else int(made.materials[faces[0]]),
        )

    def get_utilization(self, atlas_index: int) -> float:
        """Return the share of a page that charts cover. Raises IndexError where there is none."""
        return float(self._utilisations[self._page(atlas_index)])

    def get_chart_image(self, atlas_index: int) -> Array:
        """Return a picture of a page, (height, width, 3) of uint8: charts in colours, black beside.

        The first row is that of v = 0.

        Parameters
        ----------
        atlas_index : int
            The page, from 0.

        Raises
        ------
        IndexError
            There is no such page.
        RuntimeError
            `PackOptions.create_image` was not set.
        """
        page = self._page(atlas_index)
        if not self._has_image:
            raise RuntimeError("the atlas has no image: set create_image in pack_options")
        points, faces, numbers = [], [], []
        vertex, chart = 0, 0
        for made in self._made:
            on_page = np.zeros(len(made.faces), bool)
            placed = made.chart_of_face >= 0
            on_page[placed] = made.page_of_chart[made.chart_of_face[placed]] == page
            points.append(made.uvs.astype(float) * self._side)
            faces.append(made.faces[on_page].astype(np.int64) + vertex)
            numbers.append(made.chart_of_face[on_page] + chart)
            vertex += len(made.uvs)
            chart += len(made.page_of_chart)
        corners = np.concatenate(points)
        raster = _raster.rasterize(
            corners, np.zeros(len(corners)), np.concatenate(faces), self._side, self._side
        )
        image = np.zeros((self._side, self._side, 3), np.uint8)
        shown = raster.face >= 0
        image[shown] = colours(chart)[np.concatenate(numbers)[raster.face[shown]]]
        return image

    @property
    def chart_image(self) -> Array:
        """The picture of the first page, see `get_chart_image`."""
        return self.get_chart_image(0)

    @property
    def mesh_count(self) -> int:
        """The number of meshes; 0 before `generate`."""
        return len(self._made)

    @property
    def atlas_count(self) -> int:
        """The number of pages; 0 before `generate`."""
        return len(self._utilisations)

    @property
    def chart_count(self) -> int:
        """The number of charts of all meshes; 0 before `generate`."""
        return sum(len(made.page_of_chart) for made in self._made)

    @property
    def width(self) -> int:
        """Texels from the left of a page to its right; 0 before `generate`."""
        return self._side

    @property
    def height(self) -> int:
        """Texels from the bottom of a page to its top; 0 before `generate`."""
        return self._side

    @property
    def texels_per_unit(self) -> float:
        """Texels for a unit of length; 0 before `generate`."""
        return self._texels_per_unit

    @property
    def utilization(self) -> float:
        """The share of the first page that charts cover. Raises IndexError before `generate`."""
        return self.get_utilization(0)


def parametrize(
    positions: npt.ArrayLike,
    indices: npt.ArrayLike,
    normals: npt.ArrayLike | None = None,
    uvs: npt.ArrayLike | None = None,
    **options: Unpack[UnwrapOptions],
) -> tuple[Array, Array, Array]:
    """Unwrap a mesh onto one page of a texture.

    >>> import beltrami.xatlas as xatlas
    >>> square = [[0.0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0]]
    >>> vmapping, indices, uvs = xatlas.parametrize(square, [[0, 1, 2], [0, 2, 3]])
    >>> vmapping.dtype.name, indices.shape, uvs.shape
    ('uint32', (2, 3), (4, 2))

    Parameters
    ----------
    positions : (n, 3) array_like of floats
        In any unit of length.
    indices : (m, 3) array_like of integers
        Vertex numbers from 0.
    normals : (n, 3) array_like of floats, optional
        Without effect.
    uvs : (n, 2) array_like of floats, optional
        Without effect here: `Atlas.generate` uses them with `ChartOptions.use_input_mesh_uvs`.
    **options
        As for `Atlas.generate`.

    Returns
    -------
    vmapping : (k,) array of uint32
        The vertex of the mesh that each new vertex is a copy of: ``positions[vmapping]``.
    indices : (m, 3) array of uint32
        The new vertices of the faces, which are those of the mesh in their order.
    uvs : (k, 2) array of float32
        One (u, v) per new vertex, in the unit square.

    Raises
    ------
    IndexOutOfRangeError, MeshError, TypeError, ValueError, KeyboardInterrupt
        As `Atlas.add_mesh` and `Atlas.generate` do.
    """
    atlas = Atlas()
    atlas.add_mesh(positions, indices, normals, uvs)
    atlas.generate(**options)
    return atlas.get_mesh(0)


def export(
    path: str | os.PathLike[str],
    positions: npt.ArrayLike,
    indices: npt.ArrayLike | None = None,
    uvs: npt.ArrayLike | None = None,
    normals: npt.ArrayLike | None = None,
) -> None:
    """Write a mesh as an OBJ file, its numbers as float32 to the last bit.

    >>> import pathlib, tempfile
    >>> import beltrami.xatlas as xatlas
    >>> triangle = [[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "triangle.obj"
    >>> xatlas.export(path, triangle, [[0, 1, 2]], [[0.0, 0], [0.5, 0], [0, 0.5]])
    >>> path.read_text().splitlines()[-2:]
    ['vt 0 0.5', 'f 1/1 2/2 3/3']

    Parameters
    ----------
    path : path
        Of the file, which is replaced.
    positions : (n, 3) array_like of floats
        Of vertices: ``positions[vmapping]`` of `parametrize`.
    indices : (m, 3) array_like of integers, optional
        Vertices of the faces, from 0.
    uvs : (n, 2) array_like of floats, optional
        One (u, v) per vertex.
    normals : (n, 3) array_like of floats, optional
        One per vertex.

    Raises
    ------
    OSError
        The file cannot be written.
    TypeError, ValueError
        For arrays of other shapes or types.
    """
    points = _arrays.positions(shaped("positions", positions, 3))
    rows = [("v", points)]
    faces = None if indices is None else _arrays.indices(shaped("indices", indices, 3))
    if normals is not None:
        rows.append(("vn", _arrays.positions(shaped("normals", normals, 3, len(points)))))
    if uvs is not None:
        rows.append(("vt", _arrays.coordinates(shaped("uvs", uvs, 2, len(points)))))
    lines = []
    for word, array in rows:
        form = word + array.shape[1] * " %.9g"
        lines += [form % tuple(row) for row in array.astype(np.float32).tolist()]
    if faces is not None:
        corner = {(False, False): "{0}", (True, False): "{0}/{0}", (False, True): "{0}//{0}"}.get(
            (uvs is not None, normals is not None), "{0}/{0}/{0}"
        )
        form = "f " + " ".join(corner.replace("0", str(k)) for k in range(3))
        lines += [form.format(*face) for face in (faces.astype(np.int64) + 1).tolist()]
    with Path(path).open("w", encoding="ascii", newline="\n") as file:
        file.write("\n".join(lines) + "\n")
