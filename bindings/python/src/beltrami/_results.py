"""What flattening returns."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from ._arrays import Array
from ._tables import Certificate, Energy, Options, Report, Stage


@dataclass(frozen=True, eq=False)
class Parameterization:
    """UVs and all that is known about them. It equals itself only: compare what it holds.

    Attributes
    ----------
    uv : (n, 2) array of float32 or float64
        One (u, v) per vertex of the input, in its order, in its unit of length (or in the unit
        square, with `unit_square`). Vertices that no face uses have (0, 0).
    faces : (m, 3) array of integers
        The triangles that the map and its certificate speak of: the faces given, in place where
        they needed no conversion; with `delaunay` those of the intrinsic Delaunay triangulation.
    status : str
        "BELTRAMI_OK"; "BELTRAMI_NOT_CONVERGED", where the map is injective, but an optimisation
        stopped at its iteration limit; "BELTRAMI_NOT_INJECTIVE", or with the option `float32`
        "BELTRAMI_NOT_INJECTIVE_FLOAT32".
    certificate : Certificate
        The exact verdict on the very numbers in `uv`.
    energy : Energy
        Distortion of the map in double precision.
    stages : tuple of Stage
        What each stage took, in the order in which they ran.
    report : Report
        Counts, area and cost.
    options : Options
        The options that were used, by keyword.
    mesh : trimesh.Trimesh | None
        Where a ``trimesh.Trimesh`` was given: a copy with the UVs.

    Examples
    --------
    >>> vertices = [[0.0, 0, 0], [1, 0, 0], [1, 1, 1], [0, 1, 0]]
    >>> result = beltrami.parameterize(vertices, [[0, 1, 2], [0, 2, 3]])
    >>> result.status, result.certificate.positive, [stage.name for stage in result.stages][-1]
    ('BELTRAMI_OK', 2, 'certify')
    """

    uv: Array = field(repr=False)
    faces: Array = field(repr=False)
    status: str
    certificate: Certificate
    energy: Energy
    stages: tuple[Stage, ...] = field(repr=False)
    report: Report = field(repr=False)
    options: Options = field(repr=False)
    mesh: Any | None = field(default=None, repr=False)

    @property
    def injective(self) -> bool:
        """Whether the map is proven to be injective, as numbers of the type that `uv` has."""
        return self.certificate.injective

    @property
    def converged(self) -> bool:
        """Whether no optimisation stopped at its iteration limit."""
        return self.status != "BELTRAMI_NOT_CONVERGED"
