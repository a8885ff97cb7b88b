"""What a type checker knows about the package, as its users meet it; ./dev lint runs mypy on it.

Where a line is to be refused, strict mypy refuses the comment if it is not.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

import beltrami
import beltrami.xatlas as xatlas


def flatten(vertices: npt.NDArray[np.float32], faces: npt.NDArray[np.int64]) -> float:
    """Use the whole of it."""
    result = beltrami.parameterize(vertices, faces, energy="symmetric-arap", progress=True)
    element: int | None = result.certificate.first_bad_face
    names: list[str] = [stage.name for stage in result.stages]
    flattener = beltrami.Flattener(method="cm", threads=2)
    flattener.set_options(refine=True, time_limit=2.5)
    options: beltrami.Options = flattener.options
    records = beltrami.batch(["a.obj"], "out", threads=options["threads"])
    good: bool = records[0].ok and bool(beltrami.check_injective(result.uv, faces))
    print(element, names, good)
    return result.energy.symmetric_dirichlet


def unwrap(vertices: npt.NDArray[np.float32], quads: npt.NDArray[np.int64]) -> float:
    """Use atlases."""
    atlas: beltrami.Atlas = beltrami.unwrap(vertices, quads, weld="off", threads=2)
    of_list = beltrami.unwrap(vertices, [[0, 1, 2], [0, 2, 3, 4]], progress=True)
    names: list[str] = [chart.error for chart in of_list.charts]
    good: bool = atlas.injective and bool(beltrami.check_atlas(vertices, quads, atlas.corner_uvs))
    split, _, uvs = atlas.split()
    beltrami.plot.atlas(atlas)
    beltrami.plot.heat_map(atlas, measure="area")
    records = beltrami.unwrap_batch(["a.obj"], "out", cut="islands", labels="materials")
    print(names, good, split, uvs, records[0].ok, atlas.options["weld"])
    return atlas.energy


def as_xatlas(vertices: npt.NDArray[np.float64], faces: npt.NDArray[np.int64]) -> int:
    """Use the interface of xatlas."""
    vmapping, indices, uvs = xatlas.parametrize(vertices, faces, effort="normal")
    options = xatlas.PackOptions()
    options.padding, options.blockAlign = 2, True
    several = xatlas.Atlas()
    several.add_mesh(vertices, faces, uvs=uvs)
    several.generate(xatlas.ChartOptions(), options, target_energy=2.1)
    charts: list[xatlas.Chart] = [several.get_mesh_chart(0, 0)]
    print(vmapping, indices, charts[0].type is xatlas.ChartType.LSCM, several[0])
    return len(several)


def refused(vertices: npt.NDArray[np.float32], faces: npt.NDArray[np.int64]) -> None:
    """Make mistakes."""
    beltrami.parameterize(vertices, faces, energy="dirichlet")  # type: ignore[arg-type]
    beltrami.parameterize(vertices, faces, colour="red")  # type: ignore[call-arg]
    beltrami.parameterize(vertices, faces, progress=3)  # type: ignore[arg-type]
    beltrami.parameterize(vertices, faces, weld="off")  # type: ignore[call-arg]
    beltrami.unwrap(vertices, faces, delaunay=True)  # type: ignore[call-overload]
    beltrami.unwrap(vertices, faces, weld="maybe")  # type: ignore[call-overload]
    xatlas.parametrize(vertices, faces, colour="red")  # type: ignore[call-arg]
    beltrami.Flattener().set_options(thread=2)  # type: ignore[call-arg]
    beltrami.plot.heat_map(vertices, faces, vertices, measure="angle")  # type: ignore[call-overload]
