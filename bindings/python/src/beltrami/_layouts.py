"""What is drawn of an atlas: its UVs at the scale of the surface, and their distortion."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from . import _view
from ._arrays import Array
from ._checks import distortion

_SLIVERS = 1e-6  # of the area, which no mean counts: as in `AtlasReport.slivers`


@dataclass(frozen=True, eq=False)
class Layout:
    """The triangles of an atlas.

    Attributes
    ----------
    space : (k, 3) array of float64
        Where UV vertices are on the surface.
    triangles : (t, 3) array of integers
        UV vertices, in the orientation in which they are positive.
    energies : (t,) array of float64
        Symmetric Dirichlet energy; infinite for flipped ones, NaN without area on the surface.
    areas : (t,) array of float64
        On the surface.
    unit : float
        The surface's units of length in a unit of the UVs, so that the mean energy is least.
    """

    space: Array
    triangles: Array
    energies: Array
    areas: Array
    unit: float


def layout(atlas: Any) -> Layout:
    """Measure an `Atlas` triangle by triangle, at one scale for all as its report does."""
    space, triangles, uvs = atlas.split(triangles=True)
    space, triangles = space.astype(float), np.asarray(triangles)
    found = distortion(space, triangles, uvs.astype(float))
    areas: Array = 0.5 * np.linalg.norm(_view.face_normals(space, triangles), axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        first, second = found.singular_values.T
        grown, shrunk = first**2 + second**2, first**-2 + second**-2
        good = np.flatnonzero((second > 0) & np.isfinite(shrunk) & np.isfinite(grown))
        unit = 1.0
        for _ in range(2):  # what counts as a sliver depends on the scale
            energies = 0.5 * (unit**2 * grown + shrunk / unit**2)
            order = good[np.argsort(-energies[good], kind="stable")]
            counted = order[np.cumsum(areas[order]) > _SLIVERS * areas[order].sum()]
            weights = areas[counted]
            if len(counted) and weights @ grown[counted] > 0:
                unit = float((weights @ shrunk[counted]) / (weights @ grown[counted])) ** 0.25
        energies = 0.5 * (unit**2 * grown + shrunk / unit**2)
    energies[second <= 0] = np.inf
    energies[~np.isfinite(second)] = np.nan
    return Layout(space, triangles, energies, areas, unit)


def rounded_up(value: float) -> float:
    """Return a number of two digits that is no less."""
    unit = 10.0 ** (np.floor(np.log10(value)) - 1)
    return float(f"{np.ceil(value / unit - 1e-9) * unit:.2g}")


def most(values: Array, areas: Array) -> float:
    """Return the number that 99% of the area do not exceed, among the finite ones."""
    finite = np.isfinite(values) & np.isfinite(areas)
    if not finite.any():
        return 0.0
    order = np.argsort(values[finite])
    share = np.cumsum(areas[finite][order])
    at = np.searchsorted(share, 0.99 * share[-1])
    return float(values[finite][order][min(int(at), len(order) - 1)])
