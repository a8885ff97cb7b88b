"""Baking of the C library as Python sees it: beside `_library` and `_surfaces` knows CFFI."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ._arrays import Array
from ._library import Context, Hook, buffer, sized
from ._native import ffi, lib

PIXELS = {
    "linear": lib.BELTRAMI_PIXELS_LINEAR,
    "srgb": lib.BELTRAMI_PIXELS_SRGB,
    "srgb-alpha": lib.BELTRAMI_PIXELS_SRGB_ALPHA,
    "normals": lib.BELTRAMI_PIXELS_NORMALS,
    "occlusion": lib.BELTRAMI_PIXELS_OCCLUSION,
}
FILTERS = {"linear": lib.BELTRAMI_FILTER_LINEAR, "nearest": lib.BELTRAMI_FILTER_NEAREST}
WRAPS = {
    "repeat": lib.BELTRAMI_WRAP_REPEAT,
    "clamp": lib.BELTRAMI_WRAP_CLAMP,
    "mirror": lib.BELTRAMI_WRAP_MIRROR,
}
_TYPES = {"u1": lib.BELTRAMI_U8, "u2": lib.BELTRAMI_U16, "f4": lib.BELTRAMI_F32}


@dataclass(frozen=True, eq=False)
class BakeArrays:
    """A job in arrays: images (h, w, c) of one type, and rows for each corner or face."""

    images: Sequence[Array]
    buffers: dict[str, Array]  # by the names of the fields
    numbers: dict[str, float]  # likewise


@dataclass(frozen=True)
class BakeCounts:
    """What is told of a bake."""

    texels: int
    without_source: int
    old_texels: float
    seconds: float
    cpu_seconds: float


class BakeContext(Context):
    """A context that bakes."""

    def bake(
        self, arrays: BakeArrays, pixels: Array, masks: Array | None, hook: Hook
    ) -> BakeCounts:
        """Bake into `pixels` and `masks`. Raises what the hook raises."""
        job = sized("beltrami_bake_job")
        images = ffi.new("beltrami_image[]", len(arrays.images))
        for view, image in zip(images, arrays.images):
            view.pixels = ffi.cast("void*", image.ctypes.data)
            view.height, view.width, view.channels = image.shape
            view.type = _TYPES[image.dtype.str[1:]]
        job.images, job.image_count = images, len(arrays.images)
        for name, array in arrays.buffers.items():
            setattr(job, name, buffer(array))
        for name, number in arrays.numbers.items():
            setattr(job, name, number)
        out = sized("beltrami_baked")
        out.pixels = ffi.cast("void*", pixels.ctypes.data)
        if masks is not None:
            out.masks = ffi.cast("uint8_t*", masks.ctypes.data)
        self.call(lib.beltrami_bake, (job, out), hook)
        return BakeCounts(
            out.texels, out.without_source, out.old_texels, out.seconds, out.cpu_seconds
        )


def whole_page() -> int:
    """Return the gutter that fills a page."""
    return int(np.iinfo(np.uint64).max)
