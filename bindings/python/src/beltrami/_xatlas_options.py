"""What the package ``xatlas`` has of options, and of charts: of `beltrami.xatlas`."""

from __future__ import annotations

import enum
from dataclasses import dataclass

from ._arrays import Array


class ChartType(enum.IntEnum):
    """How a chart was flattened. Charts of beltrami are LSCM, or Invalid where one has no map."""

    Planar = 0
    Ortho = 1
    LSCM = 2
    Piecewise = 3
    Invalid = 4

    def __str__(self) -> str:
        return f"ChartType.{self.name}"


class ChartOptions:
    """Where seams go. Of these `use_input_mesh_uvs` has an effect, the others have none.

    What beltrami has in their place are keywords of `Atlas.generate`, such as ``target_energy=2.1``
    and ``hard_angle=60``.

    Attributes
    ----------
    use_input_mesh_uvs : bool, default False
        True keeps the charts of the UVs of a mesh, where it has some, and flattens them anew.
    max_chart_area, max_boundary_length : float, default 0.0
        Without effect.
    normal_deviation_weight : float, default 2.0
        Without effect.
    roundness_weight : float, default 0.01
        Without effect.
    straightness_weight : float, default 6.0
        Without effect.
    normal_seam_weight : float, default 4.0
        Without effect.
    texture_seam_weight : float, default 0.5
        Without effect.
    max_cost : float, default 2.0
        Without effect.
    max_iterations : int, default 1
        Without effect.
    fix_winding : bool, default False
        Without effect: faces that disagree with most of their component are turned in any case.
    """

    __slots__ = (
        "fix_winding",
        "max_boundary_length",
        "max_chart_area",
        "max_cost",
        "max_iterations",
        "normal_deviation_weight",
        "normal_seam_weight",
        "roundness_weight",
        "straightness_weight",
        "texture_seam_weight",
        "use_input_mesh_uvs",
    )

    def __init__(self) -> None:
        self.max_chart_area = 0.0
        self.max_boundary_length = 0.0
        self.normal_deviation_weight = 2.0
        self.roundness_weight = 0.01
        self.straightness_weight = 6.0
        self.normal_seam_weight = 4.0
        self.texture_seam_weight = 0.5
        self.max_cost = 2.0
        self.max_iterations = 1
        self.use_input_mesh_uvs = False
        self.fix_winding = False


class PackOptions:
    """How charts lie on the pages.

    Attributes
    ----------
    resolution : int, default 0
        Texels to the side of a page; 0 takes 1024, or with `texels_per_unit` as many as all charts
        need on one page.
    texels_per_unit : float, default 0.0
        Texels for a unit of length. 0 makes charts as large as they fit onto one page. With a
        `resolution`, too, there are as many pages as there have to be.
    padding : int, default 0
        Texels around each chart: between two charts there are twice as many, and one more.
    bilinear : bool, default True
        True keeps one texel more between two charts.
    blockAlign : bool, default False
        True has no two charts share a block of 4 x 4 texels.
    rotate_charts, rotate_charts_to_axis : bool, default True
        Both: charts are turned as it fits best. Without `rotate_charts` their least box lies along
        the texels. Without `rotate_charts_to_axis` they are not turned.
    create_image : bool, default False
        True lets `Atlas.chart_image` draw the charts.
    bruteForce : bool, default False
        Without effect.
    max_chart_size : int, default 0
        Without effect.
    """

    __slots__ = (
        "bilinear",
        "blockAlign",
        "bruteForce",
        "create_image",
        "max_chart_size",
        "padding",
        "resolution",
        "rotate_charts",
        "rotate_charts_to_axis",
        "texels_per_unit",
    )

    def __init__(self) -> None:
        self.max_chart_size = 0
        self.padding = 0
        self.texels_per_unit = 0.0
        self.resolution = 0
        self.bilinear = True
        self.blockAlign = False
        self.bruteForce = False
        self.create_image = False
        self.rotate_charts_to_axis = True
        self.rotate_charts = True


@dataclass(frozen=True, eq=False)
class Chart:
    """A chart of a mesh.

    Attributes
    ----------
    faces : (k,) array of uint32
        Its faces, in order.
    atlas_index : int
        Its page.
    type : ChartType
        How it was flattened.
    material : int
        Of a mesh of UVs, the material of its faces; else 0.
    """

    faces: Array
    atlas_index: int
    type: ChartType
    material: int
