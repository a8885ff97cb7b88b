"""Pictures of maps with Matplotlib: ``pip install beltrami[plot]``.

Every function draws into the axes that it is given, or into a new figure, and returns the axes. The
faces are drawn as pixels and the lines as lines, so a file of millions of faces stays small and
opens fast.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, overload

import numpy as np
import numpy.typing as npt

from . import _arrays, _layouts, _raster, _view
from ._arrays import Array
from ._atlas import Atlas, SceneAtlases, tile_of
from ._checks import Distortion, check_triangles
from ._checks import distortion as _distortion
from ._layouts import most, rounded_up

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["atlas", "checkered", "heat_map", "layout"]

#: What a heat map may show.
Measure = Literal["symmetric-dirichlet", "symmetric-arap", "area", "conformal"]

_SAMPLES = 2  # per pixel and direction, against jagged edges
_FILL = (0.80, 0.86, 0.93)
_CHARTS = np.array(
    [
        *([0.80, 0.86, 0.93], [0.93, 0.85, 0.76], [0.81, 0.91, 0.80], [0.92, 0.82, 0.88]),
        *([0.93, 0.91, 0.74], [0.78, 0.90, 0.91], [0.87, 0.83, 0.94], [0.90, 0.88, 0.84]),
    ]
)
_LINE = (0.13, 0.16, 0.22)
_BAD = (0.86, 0.10, 0.10)
_CHECKER = np.array([[0.95, 0.94, 0.91], [0.27, 0.43, 0.62]])
_BACK = np.array([[0.72, 0.64, 0.60], [0.55, 0.42, 0.38]])
# Edges are drawn where a face has at least so many pixels, and as fine as faces are small: thin
# ones show how dense the triangles are.
_LEAST_FACE = 4.0
_FULL_FACE = 60.0
_MANY_LINES = 20_000  # more are drawn as pixels, or files would be large


def layout(
    uv: npt.ArrayLike,
    faces: npt.ArrayLike,
    ax: Axes | None = None,
    *,
    edges: bool | None = None,
    resolution: int = 1200,
) -> Axes:
    """Draw a UV layout: its triangles, its boundary, and in red what is flipped.

    Parameters
    ----------
    uv : (n, 2) array_like of floats
        One per vertex.
    faces : (m, 3) array_like of integers
        Vertex numbers from 0.
    ax : matplotlib.axes.Axes, optional
        Left out, a new figure is made.
    edges : bool, optional
        Whether to draw the edges; left out, they are drawn where the faces are large enough.
    resolution : int
        Pixels along the longer side.

    Returns
    -------
    matplotlib.axes.Axes
        With equal scales, and no frame.

    Raises
    ------
    ImportError
        Without Matplotlib.
    IndexOutOfRangeError, NonFiniteError
        With the face or the vertex.
    TypeError, ValueError
        For arrays of other shapes or types, and without faces.

    Examples
    --------
    >>> uv = [[0.0, 0], [1, 0], [1, 1], [0, 1]]
    >>> ax = beltrami.plot.layout(uv, [[0, 1, 2], [0, 2, 3]])
    >>> ax.figure.savefig("layout.png")
    """
    points, triangles = _arrays.coordinates(uv).astype(float), _arrays.indices(faces)
    check_triangles(points, triangles)  # refuses what cannot be drawn
    fill = np.broadcast_to(_FILL, (len(triangles), 3))
    return _draw_layout(points, triangles, fill, ax, edges, resolution)


def atlas(
    unwrapped: Atlas | SceneAtlases,
    ax: Axes | None = None,
    *,
    edges: bool | None = None,
    resolution: int = 1200,
) -> Axes:
    """Draw an atlas: its charts in colours of their own, their boundaries, in red what is flipped.

    Pages lie as the tiles of UDIM do: side by side, ten in a row.

    Parameters
    ----------
    unwrapped : Atlas or SceneAtlases
        What `beltrami.unwrap` returned. Of a scene whose meshes share no page, the pages of each
        follow those of the one before.
    ax : matplotlib.axes.Axes, optional
        Left out, a new figure is made.
    edges : bool, optional
        Whether to draw the edges; left out, they are drawn where the faces are large enough.
    resolution : int
        Pixels along the longer side.

    Returns
    -------
    matplotlib.axes.Axes
        With equal scales, and no frame.

    Raises
    ------
    ImportError
        Without Matplotlib.
    ValueError
        For several meshes of a scene that lie on no pages.

    Examples
    --------
    >>> vertices = [[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> atlas = beltrami.unwrap(vertices, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    >>> beltrami.plot.atlas(atlas).figure.savefig("atlas.png")
    """
    if isinstance(unwrapped, SceneAtlases):
        points, triangles, chart = _of_scene(list(unwrapped.atlases.values()))
    else:
        points, triangles = unwrapped.udim_uvs.astype(float), unwrapped.uv_triangles
        chart = unwrapped.chart_of_face[unwrapped.face_of_triangle]
    return _draw_layout(points, triangles, _CHARTS[chart % len(_CHARTS)], ax, edges, resolution)


def _of_scene(atlases: list[Atlas]) -> tuple[Array, Array, Array]:
    """Return the UVs, triangles and their charts of all atlases, side by side."""
    if len(atlases) > 1 and any(one.packing is None for one in atlases):
        raise ValueError("without pages the meshes of a scene lie on each other: draw one by one")
    parts: list[tuple[Array, Array, Array]] = []
    pages = vertices = charts = 0
    before = None
    for one in atlases:
        if before is not None and one.packing is not before:  # with share_page all have the same
            pages += before.pages
        before = one.packing
        tiles = tile_of(one.page_of_uv + pages, float) if before is not None else 0.0
        chart = one.chart_of_face[one.face_of_triangle] + charts
        parts.append((one.uvs + tiles, one.uv_triangles + vertices, chart))
        vertices += len(one.uvs)
        charts += len(one.charts)
    points, triangles, chart = map(np.concatenate, zip(*parts))
    return points, triangles, chart


def _draw_layout(
    points: Array,
    triangles: Array,
    fill: Array,
    ax: Axes | None,
    edges: bool | None,
    resolution: int,
) -> Axes:
    """Draw triangles in their colours, (m, 3)."""
    canvas = _Canvas.around(points[triangles].reshape(-1, 2), resolution)
    flipped = _areas(points, triangles) < 0
    colours = np.where(flipped[:, None], _BAD, fill)
    # Flipped faces lie on top of what they overlap.
    image = canvas.draw(points, triangles, colours, flipped.astype(float))
    ax = _axes(ax)
    canvas.show(ax, image)
    pixels_per_face = canvas.area / len(triangles)
    if edges is None:
        edges = pixels_per_face > _LEAST_FACE
    if edges:
        width = 0.25 * min(1.0, pixels_per_face / _FULL_FACE) ** 0.5
        _lines(ax, points, _edges(triangles), width, 0.7)
    _lines(ax, points, _boundary(triangles), 0.8, 1.0)
    return ax


@overload
def heat_map(
    vertices: npt.ArrayLike,
    faces: npt.ArrayLike,
    uv: npt.ArrayLike,
    ax: Axes | None = None,
    *,
    measure: Measure = "symmetric-dirichlet",
    limit: float | None = None,
    cmap: str | None = None,
    resolution: int = 1200,
) -> Axes: ...
@overload
def heat_map(
    vertices: Atlas,
    faces: None = None,
    uv: None = None,
    ax: Axes | None = None,
    *,
    measure: Measure = "symmetric-dirichlet",
    limit: float | None = None,
    cmap: str | None = None,
    resolution: int = 1200,
) -> Axes: ...
def heat_map(
    vertices: Any,
    faces: Any = None,
    uv: Any = None,
    ax: Axes | None = None,
    *,
    measure: Measure = "symmetric-dirichlet",
    limit: float | None = None,
    cmap: str | None = None,
    resolution: int = 1200,
) -> Axes:
    """Draw a UV layout coloured by the distortion of each face, with a colour bar.

    Parameters
    ----------
    vertices : (n, 3) array_like of floats, or Atlas
        Positions. An `Atlas` brings its faces and UVs: they are drawn at the scale at which their
        mean energy is least, and its pages lie as the tiles of UDIM do.
    faces : (m, 3) array_like of integers
        Vertex numbers from 0. Left out with an atlas.
    uv : (n, 2) array_like of floats
        In the unit of length of the positions. Left out with an atlas.
    ax : matplotlib.axes.Axes, optional
        Left out, a new figure is made.
    measure : {"symmetric-dirichlet", "symmetric-arap", "area", "conformal"}
        What the colours mean: one of the energies, area in the plane over area in space, or s1 / s2
        (1 where angles are kept). Flipped faces are red.
    limit : float, optional
        The end of the scale, above that of no distortion; left out, 1% of the surface may lie
        beyond it.
    cmap : str, optional
        Name of a colour map of Matplotlib.
    resolution : int
        Pixels along the longer side.

    Returns
    -------
    matplotlib.axes.Axes
        With equal scales, and no frame; its figure has the colour bar.

    Raises
    ------
    ImportError
        Without Matplotlib.
    BeltramiError, TypeError, ValueError
        As `beltrami.distortion` does, and for a limit that the scale cannot end at.

    Examples
    --------
    >>> vertices = [[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> atlas = beltrami.unwrap(vertices, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    >>> beltrami.plot.heat_map(atlas).figure.savefig("heat.png")
    """
    from matplotlib import colormaps
    from matplotlib.cm import ScalarMappable

    if isinstance(vertices, Atlas):
        if faces is not None or uv is not None:
            raise TypeError("an atlas brings its faces and UVs: give ax by its name")
        drawn = _layouts.layout(vertices)
        vertices, faces, uv = drawn.space, drawn.triangles, vertices.udim_uvs * drawn.unit
    elif faces is None or uv is None:
        raise TypeError("faces and uv are missing: only an atlas brings its own")
    found = _distortion(vertices, faces, uv)
    points, triangles = _arrays.coordinates(uv).astype(float), _arrays.indices(faces)
    scale = _Scale(measure, found, _areas_in_space(vertices, triangles), limit)
    colours = colormaps[cmap or scale.cmap](scale.norm(scale.values))[:, :3]
    flipped = found.flipped
    colours[flipped] = _BAD
    canvas = _Canvas.around(points[triangles].reshape(-1, 2), resolution)
    image = canvas.draw(points, triangles, colours, flipped.astype(float))
    ax = _axes(ax)
    canvas.show(ax, image)
    _lines(ax, points, _boundary(triangles), 0.6, 1.0)
    bar = ax.figure.colorbar(
        ScalarMappable(scale.norm, cmap or scale.cmap),
        ax=ax,
        extend=scale.extend,
        shrink=0.7,
        label=scale.label,
        ticks=scale.ticks(),
        format="{x:.2g}",
    )
    bar.ax.minorticks_off()
    return ax


def checkered(
    vertices: npt.ArrayLike,
    faces: npt.ArrayLike,
    uv: npt.ArrayLike,
    ax: Axes | None = None,
    *,
    cells: int = 40,
    view: npt.ArrayLike | None = None,
    up: npt.ArrayLike | None = None,
    resolution: int = 1200,
) -> Axes:
    """Draw the model with a checkerboard mapped through its UVs, shaded by its normals.

    Squares of one size and with right angles show a map without distortion. The inner side of the
    surface has other colours.

    Parameters
    ----------
    vertices : (n, 3) array_like of floats
        Positions.
    faces : (m, 3) array_like of integers
        Vertex numbers from 0.
    uv : (n, 2) array_like of floats
        One per vertex.
    ax : matplotlib.axes.Axes, optional
        Left out, a new figure is made.
    cells : int
        Squares along the longer side of the layout.
    view : (3,) array_like of floats, optional
        Direction from the model to the viewer; left out, one that shows most of the surface.
    up : (3,) array_like of floats, optional
        What is up in the picture; left out, y, or where the boundary tells otherwise an axis away
        from it.
    resolution : int
        Pixels along the longer side.

    Returns
    -------
    matplotlib.axes.Axes
        With equal scales, and no frame.

    Raises
    ------
    ImportError
        Without Matplotlib.
    IndexOutOfRangeError, NonFiniteError
        With the face or the vertex.
    TypeError, ValueError
        For arrays of other shapes or types, and without faces.

    Examples
    --------
    >>> vertices = [[0.0, 0, 0], [1, 0, 0], [1, 1, 1], [0, 1, 0]]
    >>> result = beltrami.parameterize(vertices, [[0, 1, 2], [0, 2, 3]])
    >>> ax = beltrami.plot.checkered(vertices, result.faces, result.uv, cells=8)
    >>> ax.figure.savefig("checkered.png")
    """
    _require_positive("cells", cells)
    space, triangles = _arrays.positions(vertices).astype(float), _arrays.indices(faces)
    coordinates = _arrays.coordinates(uv).astype(float)
    _distortion(space, triangles, coordinates)  # refuses what cannot be drawn
    boundary = _boundary(triangles)
    frame = _view.frame(space, triangles, space[np.unique(boundary)], view, up)
    seen = (space - space[triangles].reshape(-1, 3).mean(axis=0)) @ frame.T
    canvas = _Canvas.around(seen[triangles, :2].reshape(-1, 2), resolution)
    points = canvas.pixels(seen[:, :2])
    raster = _raster.rasterize(points, seen[:, 2], triangles, canvas.width, canvas.height)
    pixels, face, weights = _raster.barycentric(points, triangles, raster)
    corners = triangles[face]
    normals = np.einsum("ik,ikj->ij", weights, (_view.normals(space, triangles) @ frame.T)[corners])
    at = np.einsum("ik,ikj->ij", weights, coordinates[corners])
    used = coordinates[triangles].reshape(-1, 2)
    low, high = used.min(axis=0), used.max(axis=0)
    side = (max(high - low) or 1.0) / cells
    square = ((at - low) / side).astype(np.int64).sum(axis=1) % 2
    # Turned to the viewer or away, by the face itself: interpolated normals err at silhouettes.
    back = (_areas(seen[:, :2], triangles) < 0)[face]
    colours = np.where(back[:, None], _BACK[square], _CHECKER[square])
    image = np.zeros((canvas.height * canvas.width, 4), np.float32)
    image[pixels, :3] = colours * _shade(normals, back)[:, None]
    image[pixels, 3] = 1
    _draw_hidden_lines(image, canvas, raster, seen, boundary)
    ax = _axes(ax)
    canvas.show(ax, image.reshape(canvas.height, canvas.width, 4))
    return ax


# ---- Pixels -------------------------------------------------------------------------------


class _Canvas:
    """A rectangle of the plane as pixels, y up; more of them than are shown in the end."""

    def __init__(self, low: Array, high: Array, resolution: int) -> None:
        _require_positive("resolution", resolution)
        extent = np.maximum(high - low, np.max(high - low) * 1e-3)
        extent = np.where(extent > 0, extent, 1.0)
        margin = 0.01 * extent.max()
        self.low = low - margin
        self.scale = _SAMPLES * resolution / float(extent.max() + 2 * margin)
        size = np.ceil((extent + 2 * margin) * self.scale / _SAMPLES).astype(int) * _SAMPLES
        self.width, self.height = int(size[0]), int(size[1])

    @classmethod
    def around(cls, points: Array, resolution: int) -> _Canvas:
        """Return a canvas that holds the points, (k, 2)."""
        return cls(points.min(axis=0), points.max(axis=0), resolution)

    @property
    def area(self) -> float:
        """Pixels that are shown."""
        return self.width * self.height / _SAMPLES**2

    def pixels(self, points: Array) -> Array:
        """Return points of the plane in pixels; y still goes up."""
        scaled: Array = (points - self.low) * self.scale
        return scaled

    def draw(self, points: Array, triangles: Array, colours: Array, depth: Array) -> Array:
        """Return a picture (height, width, 4) of faces in their colours (m, 3), at depths (m,)."""
        order = np.argsort(depth, kind="stable")  # later ones show
        raster = _raster.rasterize(
            self.pixels(points), np.zeros(len(points)), triangles[order], self.width, self.height
        )
        image = np.zeros((self.height, self.width, 4), np.float32)
        shown = raster.face >= 0
        image[shown, :3] = colours[order][raster.face[shown]]
        image[shown, 3] = 1
        return image

    def show(self, ax: Any, image: Array) -> None:
        """Show a picture of this canvas, its samples averaged."""
        alpha = image[:, :, 3:]
        image = np.concatenate([image[:, :, :3] * alpha, alpha], axis=2)
        shape = (self.height // _SAMPLES, _SAMPLES, self.width // _SAMPLES, _SAMPLES, 4)
        image = image.reshape(shape).mean(axis=(1, 3))
        image[:, :, :3] /= np.maximum(image[:, :, 3:], 1e-6)
        high = self.low + np.array([self.width, self.height]) / self.scale
        ax.imshow(
            np.clip(image, 0, 1),
            extent=(self.low[0], high[0], self.low[1], high[1]),
            origin="lower",
            interpolation="antialiased",
        )
        ax.set_aspect("equal")
        ax.set_axis_off()


def _shade(normals: Array, back: Array) -> Array:
    """Return the light on each pixel: from the viewer's upper left, and some from everywhere."""
    length = np.linalg.norm(normals, axis=1)
    turned = normals / np.where(length > 0, length, 1)[:, None]
    turned = np.where(back[:, None], -turned, turned)
    light = np.array([-0.35, 0.45, 0.82])
    diffuse = np.clip(turned @ (light / np.linalg.norm(light)), 0, 1)
    shade: Array = 0.35 + 0.68 * diffuse
    return shade


def _draw_hidden_lines(
    image: Array, canvas: _Canvas, raster: _raster.Raster, seen: Array, edges: Array
) -> None:
    """Draw those parts of edges into a flat picture that no face hides."""
    start, end = seen[edges[:, 0]], seen[edges[:, 1]]
    steps = np.ceil(np.linalg.norm(end - start, axis=1) * canvas.scale).astype(np.int64) + 1
    edge = np.repeat(np.arange(len(edges)), steps)
    first = np.repeat(np.cumsum(steps) - steps, steps)
    t = (np.arange(len(edge)) - first) / np.maximum(steps - 1, 1)[edge]
    at = start[edge] + t[:, None] * (end - start)[edge]
    x, y = np.clip(canvas.pixels(at[:, :2]).astype(int).T, 0, None)
    # A line lies on the rim of its own face, which is nearer a pixel further if it is steep.
    slack = 3.0 / canvas.scale
    for dx in range(-1, 2):
        for dy in range(-1, 2):
            px = np.clip(x + dx, 0, canvas.width - 1)
            py = np.clip(y + dy, 0, canvas.height - 1)
            visible = at[:, 2] >= raster.depth[py, px] - slack
            image[(py * canvas.width + px)[visible]] = (*_LINE, 1)


def _require_positive(name: str, value: int) -> None:
    if not value >= 1:
        raise ValueError(f"{name} is {value!r}: give a number from 1")


# ---- Meshes -------------------------------------------------------------------------------


def _areas(points: Array, triangles: Array) -> Array:
    a, b, c = (points[triangles[:, k]] for k in range(3))
    u, v = b - a, c - a
    area: Array = 0.5 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    return area


def _areas_in_space(vertices: npt.ArrayLike, triangles: Array) -> Array:
    space = _arrays.positions(vertices).astype(float)
    area: Array = 0.5 * np.linalg.norm(_view.face_normals(space, triangles), axis=1)
    return area


def _edges(triangles: Array) -> Array:
    """Return every edge once, (k, 2)."""
    sides, first, _ = _sides(triangles)
    edges: Array = sides[first]
    return edges


def _boundary(triangles: Array) -> Array:
    """Return the edges of one face only, (k, 2)."""
    sides, first, counts = _sides(triangles)
    boundary: Array = sides[first[counts == 1]]
    return boundary


def _sides(triangles: Array) -> tuple[Array, Array, Array]:
    """Return the sides of all faces; the first of those on one edge each, and how many they are."""
    sides = np.concatenate([triangles[:, [k, (k + 1) % 3]] for k in range(3)]).astype(np.int64)
    low, high = sides.min(axis=1), sides.max(axis=1)
    keys = low * (int(high.max()) + 1) + high
    _, first, counts = np.unique(keys, return_index=True, return_counts=True)
    return sides, first, counts


# ---- Matplotlib ---------------------------------------------------------------------------


def _axes(ax: Axes | None) -> Any:
    if ax is not None:
        return ax
    from matplotlib import pyplot

    return pyplot.subplots(layout="constrained")[1]


def _lines(ax: Any, points: Array, edges: Array, width: float, alpha: float) -> None:
    from matplotlib.collections import LineCollection

    lines = LineCollection(
        list(points[edges]), colors=[_LINE], linewidths=width, alpha=alpha, capstyle="round"
    )
    lines.set_rasterized(len(edges) > _MANY_LINES)
    ax.add_collection(lines, autolim=False)


class _Scale:
    """The numbers of a heat map and how they become colours."""

    def __init__(
        self, measure: Measure, found: Distortion, areas: Array, limit: float | None
    ) -> None:
        from matplotlib.colors import LogNorm, Normalize

        labels = {
            "symmetric-dirichlet": "symmetric Dirichlet energy (2 is isometric)",
            "symmetric-arap": "symmetric ARAP energy (0 is isometric)",
            "area": "area in the plane / area in space",
            "conformal": "s1 / s2 (1 keeps angles)",
        }
        if measure not in labels:
            raise ValueError(f"measure is {measure!r}: give {' or '.join(map(repr, labels))}")
        self.label = labels[measure]
        self.values = {
            "symmetric-dirichlet": found.symmetric_dirichlet,
            "symmetric-arap": found.symmetric_arap,
            "area": found.area,
            "conformal": found.conformal,
        }[measure]
        self.cmap, self.extend = "viridis", "max"
        start = {"symmetric-dirichlet": 2.0, "symmetric-arap": 0.0}.get(measure, 1.0)
        if limit is not None and not limit > start:
            raise ValueError(f"limit is {limit!r}: give a number above {start:g}")
        self.norm: Any
        if measure == "area":
            self.cmap, self.extend = "RdBu_r", "both"
            end = max(1.05, float(np.exp(most(np.abs(_logarithm(self.values)), areas))))
            end = limit or rounded_up(end)
            self.norm = LogNorm(1 / end, end)
        elif measure == "symmetric-arap":
            self.norm = Normalize(start, limit or rounded_up(max(0.05, most(self.values, areas))))
        else:
            end = rounded_up(max(1.1 * start, most(self.values, areas)))
            self.norm = LogNorm(start, limit or end)

    def ticks(self) -> list[float]:
        """Return five numbers along the scale, both ends among them."""
        between = [float(f"{self.norm.inverse(place):.2g}") for place in (0.25, 0.5, 0.75)]
        return [self.norm.vmin, *between, self.norm.vmax]


def _logarithm(values: Array) -> Array:
    """Return the logarithm, without a warning where there is none."""
    with np.errstate(divide="ignore", invalid="ignore"):
        logarithm: Array = np.log(values)
    return logarithm
