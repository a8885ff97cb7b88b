"""Triangles as pixels, with NumPy alone: fast enough for millions of faces.

Pixel (x, y) has its center at (x + 0.5, y + 0.5).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ._arrays import Array

# Spans (a row of pixels in a face) that are filled at a time: bounds the memory.
_SPANS = 1_000_000


@dataclass
class Raster:
    """What is nearest at each pixel.

    Attributes
    ----------
    face : (height, width) array of int64
        The nearest face, or -1.
    depth : (height, width) array of float64
        How near it is; greater is nearer, -inf where there is none.
    """

    face: Array
    depth: Array


def rasterize(points: Array, depth: Array, faces: Array, width: int, height: int) -> Raster:
    """Return the nearest face at each pixel.

    Parameters
    ----------
    points : (n, 2) array of float64
        Corners in pixels.
    depth : (n,) array of float64
        Greater is nearer; of faces equally near, the later one shows.
    faces : (m, 3) array of integers
        Of either orientation; those without area show nowhere.
    width, height : int
        Of the picture.
    """
    face = np.full(width * height, -1, np.int64)
    nearest = np.full(width * height, -np.inf)
    corners = points[faces]
    low = np.clip(np.ceil(corners[:, :, 1].min(axis=1) - 0.5), 0, height).astype(np.int64)
    high = np.clip(np.floor(corners[:, :, 1].max(axis=1) - 0.5), -1, height - 1).astype(np.int64)
    rows = np.maximum(high - low + 1, 0)
    slopes = _planes(corners, depth[faces])
    # Blocks of faces with about as many spans each.
    blocks = np.searchsorted(np.cumsum(rows), np.arange(_SPANS, rows.sum(), _SPANS), "right")
    for chosen in np.split(np.arange(len(faces)), blocks):
        owner = np.repeat(chosen, rows[chosen])
        y = low[owner] + _counted(rows[chosen])
        first, count = _spans(corners[owner], y, width)
        pixel_owner = np.repeat(owner, count)
        x = np.repeat(first, count) + _counted(count)
        y = np.repeat(y, count)
        plane = slopes[pixel_owner]
        z = plane[:, 0] * (x + 0.5) + plane[:, 1] * (y + 0.5) + plane[:, 2]
        _keep_nearest(face, nearest, y * width + x, z, pixel_owner)
    return Raster(face.reshape(height, width), nearest.reshape(height, width))


def barycentric(points: Array, faces: Array, raster: Raster) -> tuple[Array, Array, Array]:
    """Return what shows where: pixels, their faces, and weights of the corners.

    Returns
    -------
    pixels : (k,) array of int64
        Flat numbers of the pixels that show a face.
    face : (k,) array of int64
        Which face.
    weights : (k, 3) array of float64
        Of its corners; their sum is 1.
    """
    pixels = np.flatnonzero(raster.face.ravel() >= 0)
    face = raster.face.ravel()[pixels]
    width = raster.face.shape[1]
    at = np.stack([pixels % width + 0.5, pixels // width + 0.5], axis=1)
    a, b, c = (points[faces[face, k]] for k in range(3))
    whole = _cross(b - a, c - a)
    weights = np.stack([_cross(b - at, c - at), _cross(c - at, a - at)], axis=1) / whole[:, None]
    weights = np.column_stack([weights, 1 - weights.sum(axis=1)])
    return pixels, face, weights


def _cross(u: Array, v: Array) -> Array:
    product: Array = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    return product


def _planes(corners: Array, depth: Array) -> Array:
    """Return (m, 3): depth as a linear function of x, y and 1; of faces without area, the mean."""
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    du, dv = depth[:, 1] - depth[:, 0], depth[:, 2] - depth[:, 0]
    whole = _cross(u, v)
    flat = whole == 0
    whole[flat] = 1
    planes = np.empty((len(corners), 3))
    planes[:, 0] = (du * v[:, 1] - dv * u[:, 1]) / whole
    planes[:, 1] = (dv * u[:, 0] - du * v[:, 0]) / whole
    planes[:, 2] = depth[:, 0] - (planes[:, :2] * corners[:, 0]).sum(axis=1)
    planes[flat] = 0
    planes[flat, 2] = depth[flat].mean(axis=1)
    return planes


def _counted(counts: Array) -> Array:
    """Return 0, 1, ... for each of the counts, one after the other."""
    ends = np.cumsum(counts)
    total = int(ends[-1]) if len(ends) else 0
    counted: Array = np.arange(total) - np.repeat(ends - counts, counts)
    return counted


def _spans(corners: Array, y: Array, width: int) -> tuple[Array, Array]:
    """Return the first pixel of each face in the row `y` of pixels, and how many it covers."""
    left, right = np.full(len(y), np.inf), np.full(len(y), -np.inf)
    middle = y + 0.5
    for k in range(3):
        a, b = corners[:, k], corners[:, (k + 1) % 3]
        rise = b[:, 1] - a[:, 1]
        with np.errstate(divide="ignore", invalid="ignore"):
            t = (middle - a[:, 1]) / rise
            x = a[:, 0] + t * (b[:, 0] - a[:, 0])
        met = (t >= 0) & (t <= 1)
        left = np.where(met, np.minimum(left, x), left)
        right = np.where(met, np.maximum(right, x), right)
    first = np.clip(np.ceil(left - 0.5), 0, width)
    last = np.clip(np.floor(right - 0.5), -1, width - 1)
    return first.astype(np.int64), np.maximum(last - first + 1, 0).astype(np.int64)


def _keep_nearest(face: Array, nearest: Array, pixel: Array, z: Array, owner: Array) -> None:
    """Write the faces that are nearer than what is there; of several at a pixel the nearest."""
    seen = z >= nearest[pixel]
    pixel, z, owner = pixel[seen], z[seen], owner[seen]
    order = np.argsort(z, kind="stable")  # the last of repeated indices is what stays
    face[pixel[order]] = owner[order]
    nearest[pixel[order]] = z[order]
