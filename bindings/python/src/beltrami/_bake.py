"""Baking: what images show through old UVs, for new ones."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from ._arrays import Array
from ._baking import FILTERS, PIXELS, WRAPS, BakeArrays, BakeContext, whole_page
from ._cancel import CancelToken
from ._library import BAKE
from ._progress import Progress, hook_for

# call: bake

PixelsChoice = Literal["linear", "srgb", "srgb-alpha", "normals", "occlusion"]
WrapChoice = Literal["repeat", "clamp", "mirror"]
FilterChoice = Literal["linear", "nearest"]


@dataclass(frozen=True, eq=False)
class Baked:
    """Images for new UVs. It equals itself only: compare what it holds.

    Attributes
    ----------
    images : (p, r, r) or (p, r, r, c) array
        One image for each page, rows from the top (v = 1), of the type and channels of those that
        were given; 0 where nothing is baked.
    masks : (p, r, r) array of uint8, or None
        Where asked for, a number for each texel: 0 free, 1 a gutter, 2 covered by a face.
    texels : int
        Texels that a face covers, at least in part.
    without_source : int
        Of these: those that nothing was baked for.
    old_texels : float
        Texels of the old images along the side of a new one, in the mean: above 1 the new images
        are coarser. 0 with `source_vertices`.
    seconds, cpu_seconds : float
        Wall time of the call, and processor time of the whole process during it.
    """

    images: Array = field(repr=False)
    masks: Array | None = field(repr=False)
    texels: int
    without_source: int
    old_texels: float
    seconds: float
    cpu_seconds: float


def bake(
    images: npt.ArrayLike | Sequence[npt.ArrayLike],
    old_uvs: npt.ArrayLike | None,
    new_uvs: npt.ArrayLike,
    *,
    pixels: PixelsChoice = "linear",
    resolution: int = 1024,
    gutter: int | None = None,
    wrap: WrapChoice | tuple[WrapChoice, WrapChoice] = "repeat",
    texel_filter: FilterChoice = "linear",
    old_pages: npt.ArrayLike | None = None,
    new_pages: npt.ArrayLike | None = None,
    vertices: npt.ArrayLike | None = None,
    normals: npt.ArrayLike | None = None,
    tangents: npt.ArrayLike | None = None,
    source_vertices: npt.ArrayLike | None = None,
    cage: float = 0,
    rays: int | None = None,
    # options: parameters
    threads: int = 1,
    # end of options
    masks: bool = False,
    progress: Progress = None,
    cancel: CancelToken | None = None,
) -> Baked:
    """Read images through the old UVs of triangles, and return them for the new ones.

    Where densities agree a texel is one bilinear reading; where it shows more it is the mean of up
    to 4 x 4 places in it. Where triangles overlap the first is shown. The same input gives the same
    bits, at any number of threads.

    Parameters
    ----------
    images : array_like, or sequence of them
        (h, w) or (h, w, c) with 1 to 4 channels, of uint8, uint16 or float32, rows from the top
        (v = 1). Several are the old pages, of one type and as many channels. For occlusion one, of
        any size: its type and channels are those of the result.
    old_uvs : (m, 3, 2) array_like of floats, or None
        The UVs of the corners of each triangle, in units of its image. A triangle with one that is
        not finite has no source. With `source_vertices` of those triangles. None for occlusion.
    new_uvs : (m, 3, 2) array_like of floats
        The new UVs, in the unit square of the page of the triangle.
    pixels : {"linear", "srgb", "srgb-alpha", "normals", "occlusion"}, default "linear"
        What channels are, which says how means are taken. The first are numbers as they are. Then
        come colours of sRGB, meant in linear light, with a second or fourth channel that is linear.
        The third are the same, where a colour counts by that channel. Normals are in tangent space,
        and are turned to the new axes. With "occlusion" no image is read. It is the share of a grey
        sky that a place sees, from 0 to 1 (255 or 65,535 of whole numbers), past the triangles
        themselves or `source_vertices`.
    resolution : int, default 1024
        Texels to the side of a page, 1 to 32,768.
    gutter : int, optional
        Texels around charts that continue them; None fills the whole page.
    wrap : {"repeat", "clamp", "mirror"} or a pair of them, default "repeat"
        What an image shows beyond the unit square, along u and v.
    texel_filter : {"linear", "nearest"}, default "linear"
        Whether places between texels are interpolated.
    old_pages, new_pages : (m,) array_like of integers, optional
        The image that each triangle is read from, and the page that it lies on, counted from 0; -1
        for none. Left out, all are 0.
    vertices : (m, 3, 3) array_like of floats, optional
        Positions of the corners, for normals, for occlusion and with `source_vertices`.
    normals : (m, 3, 3) array_like of floats, optional
        Normals of the corners, for normals and with a cage; NaN or left out: that of the triangle.
    tangents : (m, 3, 4) array_like of floats, optional
        For normals: the axis of the old u at each corner, and -1 where UVs are mirrored, else 1.
        Left out: as MikkTSpace has them.
    source_vertices : (s, 3, 3) array_like of floats, optional
        Positions of the corners of other triangles of the same shape, in the same place: `old_uvs`
        and `old_pages` are then of these, and each texel shows the nearest place of them. Not for
        normals.
    cage : float, default 0
        With `source_vertices`, in their unit: how far rays along `normals` look for them. A ray
        comes from as far outside and goes as far inside, and the first triangle that it comes to
        from outside is shown. Where it meets none, the nearest place is. 0: no rays.
    rays : int, optional
        For occlusion, 1 to 4,096: rays from each texel to the sky; 128 where left out.
    masks : bool, default False
        True adds which texels are covered, and which are gutters.
    progress : bool or callable, optional
        As for `parameterize`.
    cancel : CancelToken, optional
        Ends the call from any thread.

    Options
    -------
    threads : int, default 1
        Threads to use, the calling one included; the result does not depend on it. A number from 1
        to 1,024.

    Returns
    -------
    Baked
        The images, and how many texels have a source.

    Raises
    ------
    TypeError, ValueError
        For arrays of other shapes or types, numbers out of range, and triangles that lie wholly
        beyond their page.
    InvalidArgumentError
        Also where most texels have no source.
    NonFiniteError
        A new UV or a position is not finite, with the corner in `element`.
    Cancelled
        By `cancel`, or because `progress` returned False.
    KeyboardInterrupt
        On Ctrl-C, in the main thread.
    OutOfMemoryError, InternalError
        As their names say.

    Examples
    --------
    A square is turned by a quarter on its page:

    >>> import numpy as np
    >>> old = np.array([[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]], float)
    >>> new = np.stack([1 - old[..., 1], old[..., 0]], -1)
    >>> image = np.array([[1, 2], [3, 4]], np.uint8)
    >>> beltrami.bake(image, old, new, resolution=2).images[0].tolist()
    [[2, 4], [1, 3]]
    """
    given: dict[str, object] = {
        # options: items
        "threads": threads,
        # end of options
    }
    views, is_flat = _images(images)
    buffers = {"new_uvs": _corners("new_uvs", new_uvs, 2)}
    faces = len(buffers["new_uvs"]) // 3
    elsewhere = source_vertices is not None
    if source_vertices is not None:
        buffers["source_positions"] = _corners("source_vertices", source_vertices, 3)
    sources = len(buffers["source_positions"]) // 3 if elsewhere else faces
    if old_uvs is not None:
        buffers["old_uvs"] = _corners("old_uvs", old_uvs, 2, sources)
    elif pixels != "occlusion":
        raise TypeError("old_uvs are missing: only occlusion does without")
    if old_pages is not None:
        buffers["old_pages"] = _pages("old_pages", old_pages, sources)
    if new_pages is not None:
        buffers["new_pages"] = _pages("new_pages", new_pages, faces)
    _require_on_pages(buffers)
    if vertices is None and (elsewhere or pixels in ("normals", "occlusion")):
        raise TypeError("vertices are missing: normals, occlusion and source_vertices need them")
    of_corners = {"positions": (vertices, 3), "normals": (normals, 3), "tangents": (tangents, 4)}
    for name, (values, width) in of_corners.items():
        if values is not None:
            shown = "vertices" if name == "positions" else name
            buffers[name] = _corners(shown, values, width, faces)
    along_u, along_v = (wrap, wrap) if isinstance(wrap, str) else wrap
    pages = int(buffers["new_pages"].max(initial=0)) + 1 if "new_pages" in buffers else 1
    if not 1 <= resolution <= 32768:
        raise ValueError(f"resolution is {resolution}: give 1 to 32768")
    numbers: dict[str, float] = {
        "pixels": _choice("pixels", pixels, PIXELS),
        "filter": _choice("texel_filter", texel_filter, FILTERS),
        "wrap_u": _choice("wrap", along_u, WRAPS),
        "wrap_v": _choice("wrap", along_v, WRAPS),
        "face_count": faces,
        "source_face_count": sources if elsewhere else 0,
        "resolution": resolution,
        "gutter": whole_page() if gutter is None else gutter,
        "page_count": pages,
        "cage": cage,
        "rays": (128 if pixels == "occlusion" else 0) if rays is None else rays,
    }
    if numbers["rays"] < 0:
        raise ValueError(f"rays is {rays}: give 1 to 4096")
    if numbers["gutter"] < 0:
        raise ValueError(f"gutter is {gutter}: give 0 or more")
    context = BakeContext(cancel)
    context.set_options(given, BAKE)
    out = np.zeros((pages, resolution, resolution, views[0].shape[2]), views[0].dtype)
    mask = np.zeros(out.shape[:3], np.uint8) if masks else None
    with hook_for(progress) as hook:
        counts = context.bake(BakeArrays(views, buffers, numbers), out, mask, hook)
    return Baked(
        images=out[..., 0] if is_flat else out,
        masks=mask,
        texels=counts.texels,
        without_source=counts.without_source,
        old_texels=counts.old_texels,
        seconds=counts.seconds,
        cpu_seconds=counts.cpu_seconds,
    )


def _images(images: Any) -> tuple[list[Array], bool]:
    """Return arrays (h, w, c), and whether they were given without channels."""
    given = list(images) if isinstance(images, (list, tuple)) else [images]
    arrays = [np.asarray(image) for image in given]
    if not arrays:
        raise ValueError("there is no image: give one or more")
    for array in arrays:
        if array.dtype.kind + str(array.dtype.itemsize) not in ("u1", "u2", "f4"):
            raise TypeError(f"images must be of uint8, uint16 or float32, not {array.dtype}")
        if array.ndim not in (2, 3) or (array.ndim == 3 and not 1 <= array.shape[2] <= 4):
            raise ValueError(
                f"an image has the shape {array.shape}: give (h, w) or (h, w, c), 1 to 4 channels"
            )
        if array.size == 0:
            raise ValueError(f"an image has the shape {array.shape}: it has no texels")
        if array.dtype != arrays[0].dtype or array.shape[2:] != arrays[0].shape[2:]:
            raise ValueError("images must have one type and as many channels")
    whole = [
        np.ascontiguousarray(array, array.dtype.newbyteorder("=")).reshape(*array.shape[:2], -1)
        for array in arrays
    ]
    return whole, arrays[0].ndim == 2


def _corners(name: str, values: npt.ArrayLike, width: int, faces: int | None = None) -> Array:
    """Return rows for the corners of triangles, float32 or float64."""
    array = np.asarray(values)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{name} must be real numbers, not {array.dtype}")
    count = "m" if faces is None else faces
    if array.shape[1:] != (3, width) or (faces is not None and len(array) != faces):
        raise ValueError(f"{name} must have the shape ({count}, 3, {width}), not {array.shape}")
    single = array.dtype.kind == "f" and array.dtype.itemsize <= 4
    dtype = np.float32 if single else np.float64
    return np.ascontiguousarray(array, dtype).reshape(-1, width)


def _require_on_pages(buffers: dict[str, Array]) -> None:
    """Raise ValueError for a triangle that is to be baked and lies wholly beyond its page."""
    uvs = buffers["new_uvs"].reshape(-1, 3, 2)
    beyond = ((uvs.min(axis=1) > 1) | (uvs.max(axis=1) < 0)).any(axis=1)
    if "new_pages" in buffers:
        beyond &= buffers["new_pages"].ravel() >= 0
    if beyond.any():
        raise ValueError(
            f"the new UVs of triangle {int(beyond.argmax())} lie beyond its page, the unit square: "
            "give those on the page, and the page in new_pages"
        )


def _pages(name: str, values: npt.ArrayLike, faces: int) -> Array:
    array = np.asarray(values)
    if array.dtype.kind not in "iu":
        raise TypeError(f"{name} must be whole numbers, not {array.dtype}")
    if array.shape != (faces,):
        raise ValueError(f"{name} must have the shape ({faces},), not {array.shape}")
    pages = np.ascontiguousarray(array, np.int64)
    if pages.size and (pages.min() < -1 or pages.max() >= 1000):
        raise ValueError(f"{name} are pages from 0 to 999, or -1 for none")
    return pages.reshape(-1, 1)


def _choice(name: str, value: str, choices: dict[str, int]) -> int:
    if value not in choices:
        raise ValueError(f"{name} is {value!r}: choose from {', '.join(choices)}")
    return choices[value]
