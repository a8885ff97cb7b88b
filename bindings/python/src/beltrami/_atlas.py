"""What unwrapping returns."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from . import _html, _report_page, _trimesh
from ._arrays import Array
from ._tables import (
    AtlasCertificate,
    AtlasReport,
    Chart,
    PackingReport,
    Stage,
    UnwrapOptions,
)

_PAGES_IN_A_ROW = 10  # of UDIM


def tile_of(pages: Array, dtype: Any) -> Array:
    """Return the lower left corner of the tile of each page, (n, 2)."""
    corners: Array = np.stack([pages % _PAGES_IN_A_ROW, pages // _PAGES_IN_A_ROW], axis=1)
    return corners.astype(dtype)


@dataclass(frozen=True, eq=False)
class Atlas:
    """UVs of a surface that was cut into charts. It equals itself only: compare what it holds.

    UV vertices are vertices of the input, split along the seams and nowhere else: with `uv_faces`
    they are what a vertex buffer and its index buffer hold, see `split`. A corner is one vertex of
    one face; corners are counted from 0, face after face.

    Attributes
    ----------
    uvs : (k, 2) array of float32 or float64
        One (u, v) per UV vertex, in the unit square of its page. With ``pack="none"``, and with
        pins, they are in the surface's unit of length, or with `unit_square` in the unit square.
    uv_faces : (m, 3) array of integers, or list of arrays
        The UV vertex of each corner, in the shape of the faces as given; for a list of polygons of
        several sizes a list of arrays.
    origins : (k,) array of integers
        The vertex of the input that each UV vertex is a copy of.
    seams : (s, 2) array of integers
        The seams, those given and those found: edges at which UVs part, each once, the lesser
        vertex first, in increasing order; open borders are none. Of vertices that count as one it
        is the least. With ``cut="given"`` they make the same charts.
    chart_of_face : (m,) array of int64
        -1 for a face without area.
    charts : tuple of Chart
        In the order of their least faces.
    triangles : (t, 3) array of int64
        The triangles that were computed on and that the certificate speaks of, as corners, in the
        orientation in which they are positive.
    status : str
        "BELTRAMI_OK", "BELTRAMI_NOT_CONVERGED", "BELTRAMI_NOT_INJECTIVE" or
        "BELTRAMI_NOT_INJECTIVE_FLOAT32". Not converged: the atlas is injective, but an optimisation
        stopped at its iteration limit. Not injective: a chart has no map, or one that is not
        injective; its own status tells.
    certificate : AtlasCertificate
        The exact verdict on the very numbers in `uvs`.
    float32_certificate : AtlasCertificate
        The same on the numbers rounded to float32.
    report : AtlasReport
        What was met in the surface, counts, energy, seams and cost.
    stages : tuple of Stage
        What each stage took, in the order in which they ran.
    options : UnwrapOptions
        The options that were used, by keyword.
    vertices : (n, 3) array of float32 or float64
        The vertices given, in place where they needed no conversion.
    page_of_uv : (k,) array of int64
        The page of each UV vertex; 0 where the atlas is not packed.
    packing : PackingReport | None
        Pages, density, utilisation and margin; None where the atlas is not packed.
    page_utilisations : (p,) array of float64
        The share of each page that charts cover.
    mesh : trimesh.Trimesh | None
        Where a ``trimesh.Trimesh`` or the path of a file was given: a copy with the UVs, split
        along the seams. None where arrays were given: `split` has what a mesh is made of.

    Examples
    --------
    >>> vertices = [[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> atlas = beltrami.unwrap(vertices, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    >>> atlas.packing.pages, atlas.chart_of_face.tolist(), round(atlas.energy, 3)
    (1, [0, 0, 0, 0], 2.0)
    """

    uvs: Array = field(repr=False)
    uv_faces: Array | list[Array] = field(repr=False)
    origins: Array = field(repr=False)
    seams: Array = field(repr=False)
    chart_of_face: Array = field(repr=False)
    charts: tuple[Chart, ...] = field(repr=False)
    triangles: Array = field(repr=False)
    status: str
    certificate: AtlasCertificate
    float32_certificate: AtlasCertificate = field(repr=False)
    report: AtlasReport = field(repr=False)
    stages: tuple[Stage, ...] = field(repr=False)
    options: UnwrapOptions = field(repr=False)
    vertices: Array = field(repr=False)
    page_of_uv: Array = field(repr=False)
    packing: PackingReport | None = field(repr=False)
    page_utilisations: Array = field(repr=False)
    mesh: Any | None = field(default=None, repr=False)

    @property
    def injective(self) -> bool:
        """Whether the atlas is proven to be injective, as numbers of the type that `uvs` has."""
        return self.certificate.injective

    @property
    def converged(self) -> bool:
        """Whether no optimisation stopped at its iteration limit."""
        return self.status != "BELTRAMI_NOT_CONVERGED"

    @property
    def reached_target(self) -> bool | None:
        """Whether the atlas is what its seams were searched for; None with another cut."""
        return self.report.reached if self.report.searched else None

    @property
    def energy(self) -> float:
        """The mean symmetric Dirichlet energy over the area, 2 where lengths are kept."""
        return self.report.symmetric_dirichlet

    @property
    def seam_length(self) -> float:
        """The length of the seams on the surface, each counted once."""
        return self.report.seam_length

    @property
    def utilisation(self) -> float:
        """The area of the UVs over that of the pages, or else of their bounding box."""
        return self.report.utilisation

    @property
    def udim_uvs(self) -> Array:
        """A (k, 2) array of floats: the UVs in the tiles of UDIM, where page k is 1001 + k."""
        tiled: Array = self.uvs + tile_of(self.page_of_uv, self.uvs.dtype)
        return tiled

    @property
    def corner_uvs(self) -> Array:
        """An (m, k, 2) array of floats: UVs of corners; of a list of polygons (c, 2)."""
        corner_uvs: Array = self.uvs[self._faces()]
        return corner_uvs

    @property
    def uv_triangles(self) -> Array:
        """A (t, 3) array of integers: UV vertices of `triangles`, to draw and to measure."""
        uv_triangles: Array = self._faces().ravel()[self.triangles]
        return uv_triangles

    @property
    def face_of_triangle(self) -> Array:
        """A (t,) array of int64: the face that each of `triangles` is a part of."""
        if isinstance(self.uv_faces, list):
            ends = np.cumsum([len(face) for face in self.uv_faces])
            faces: Array = np.searchsorted(ends, self.triangles[:, 0], side="right")
        else:
            faces = self.triangles[:, 0] // self.uv_faces.shape[1]
        return faces

    def split(self, triangles: bool = False) -> tuple[Array, Array | list[Array], Array]:
        """Return what a vertex buffer holds: vertices split along the seams, and nowhere else.

        Of anything else that the vertices have, take ``normals[atlas.origins]``.

        Parameters
        ----------
        triangles : bool
            True gives the faces as triangles, in the orientation in which they are positive.

        Returns
        -------
        tuple of arrays
            Positions (k, 3), faces as given (or (t, 3)), and UVs (k, 2).

        Raises
        ------
        MemoryError
            Without room for them.

        Examples
        --------
        >>> vertices = [[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
        >>> atlas = beltrami.unwrap(vertices, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
        >>> positions, faces, uvs = atlas.split()
        >>> positions.shape, faces.shape, uvs.shape
        ((6, 3), (4, 3), (6, 2))
        """
        faces = self.uv_triangles if triangles else self.uv_faces
        return self.vertices[self.origins], faces, self.uvs

    def html(self, path: str | os.PathLike[str]) -> None:
        """Write a page for browsers that shows the model beside its layout, and the figures.

        It is one file, and needs no network: ``beltrami unwrap --html`` writes the same. The model
        shows a checkerboard, its distortion, its charts or a picture of yours. Numbers are in
        single precision there.

        Parameters
        ----------
        path : str or path
            Of the file to write, which is replaced. The page is named after it.

        Raises
        ------
        OSError
            Where the file cannot be written.
        """
        _report_page.write(self, path)

    def _repr_html_(self) -> str:
        """Return a picture of the layout and its figures, as notebooks show them."""
        return _html.of_atlas(self)

    def _faces(self) -> Array:
        """Return the UV vertices of corners as one array."""
        return np.concatenate(self.uv_faces) if isinstance(self.uv_faces, list) else self.uv_faces


@dataclass(frozen=True, eq=False)
class SceneAtlases:
    """What became of a ``trimesh.Scene``: an atlas for each of its meshes.

    Attributes
    ----------
    scene : trimesh.Scene
        A copy with UVs. What is no mesh, such as a point cloud, is as it was.
    atlases : dict
        The `Atlas` of each mesh, by its name in ``scene.geometry``. With ``share_page`` what it
        says of pages and the verdict on its UVs is that on all of the meshes.

    Examples
    --------
    >>> import trimesh
    >>> scene = trimesh.Scene([trimesh.creation.box(), trimesh.creation.icosphere(1)])
    >>> atlases = beltrami.unwrap(scene, share_page=True)
    >>> atlases.injective, len(atlases.atlases), atlases.mesh.visual.uv.shape[1]
    (True, 2, 2)
    """

    scene: Any
    atlases: Mapping[str, Atlas] = field(repr=False)

    @property
    def injective(self) -> bool:
        """Whether every atlas is proven to be injective."""
        return all(atlas.injective for atlas in self.atlases.values())

    @property
    def mesh(self) -> Any | None:
        """All meshes as one ``trimesh.Trimesh`` with UVs, at their places in the scene; or None.

        A scene with one mesh keeps its material, normals and attributes. Of several, positions,
        normals and UVs are joined: with ``share_page`` no two of them overlap on the texture, and
        without it each has a page of its own. It is made anew by every call, and None where the
        scene has no mesh.
        """
        return _trimesh.joined(self.scene)

    def html(self, path: str | os.PathLike[str]) -> None:
        """Write the page of `Atlas.html` for a scene with one mesh.

        Parameters
        ----------
        path : str or path
            Of the file to write, which is replaced. The page is named after it.

        Raises
        ------
        ValueError
            Of several meshes: each atlas of `atlases` writes a page of its own.
        OSError
            Where the file cannot be written.
        """
        if len(self.atlases) != 1:
            raise ValueError(
                f"a page shows one mesh, and the scene has {len(self.atlases)}: "
                "call html of each atlas of .atlases"
            )
        for atlas in self.atlases.values():
            atlas.html(path)

    def _repr_html_(self) -> str:
        """Return the picture and the figures of each atlas, as notebooks show them."""
        return _html.of_scene(self)
