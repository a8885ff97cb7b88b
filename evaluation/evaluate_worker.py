"""One run of ./dev evaluate, in a process of its own that may crash, hang or be stopped.

    evaluate_worker.py prepare MESH.json OUT.npz
    evaluate_worker.py run MESH.npz RUN.json OUT.json

MESH.json are the values of evaluate_data.Mesh, RUN.json has the program, its options, and the CPU
seconds that it may take. OUT.json gets the figures of the map. All programs run on one thread, and
all maps are measured by our functions; CPU seconds are those of the call alone.
"""

from __future__ import annotations

import importlib.metadata
import json
import os
import resource
import sys
import time
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

# Energies above that of no distortion, on a logarithmic scale: the edges of histograms.
BIN_EDGES = np.concatenate([[0.0], np.logspace(-4, 3, 43)])
# The energies whose least value is not 0.
LEAST = {"symmetric-dirichlet": 2.0}
RIVAL_ITERATIONS = 20  # of SCAF, as of the Blender default's and SLIM's usual 10 to 20
TOLERANCE = 1e-4  # of SLIM: that of CM
PACKAGES = {"SLIM": "libigl", "SCAF": "libigl", "Blender": "bpy"}


def prepare(mesh: str, out: str) -> None:
    """Make a mesh and write it; what appears is whole."""
    from evaluate_data import Mesh, make

    vertices, faces = make(Mesh(**json.loads(Path(mesh).read_text())))
    part = f"{out}.{os.getpid()}.npz"
    np.savez(part, vertices=vertices, faces=faces.astype(np.int32))
    Path(part).replace(out)


def histogram(values: np.ndarray, weights: np.ndarray, least: float) -> list[float]:
    """Return the share of the area in each bin of energies; flipped faces are in the last one."""
    known = ~np.isnan(values)
    above = np.nan_to_num(values[known] - least, posinf=np.inf)
    at = np.searchsorted(BIN_EDGES, above, side="right") - 1
    shares = np.bincount(np.clip(at, 0, len(BIN_EDGES) - 1), weights[known], len(BIN_EDGES))
    return [round(float(share), 9) for share in shares / weights[known].sum()]


def measure(vertices: np.ndarray, faces: np.ndarray, uv: np.ndarray) -> dict[str, Any]:
    """Return what holds of a map: exact counts, energies, and shares of the area by energy."""
    from meshes import areas

    import beltrami

    triangles = beltrami.check_triangles(uv, faces)
    crossings = beltrami.check_boundary(uv, faces).boundary_crossings
    found = beltrami.distortion(vertices, faces, uv)
    weights = areas(vertices, faces)
    energies, histograms = {}, {}
    for name in energy_names():
        field = name.replace("-", "_")
        value = getattr(found.energy, field, None)
        if value is None:
            continue
        energies[name] = float(value)
        if isinstance(getattr(found, field, None), np.ndarray):
            histograms[name] = histogram(getattr(found, field), weights, LEAST.get(name, 0.0))
    return {
        "flips": triangles.negative + triangles.degenerate,
        "crossings": crossings,
        "injective": triangles.negative + triangles.degenerate + crossings == 0,
        "left_out": found.energy.left_out,
        "energies": energies,
        "histograms": histograms,
    }


def energy_names() -> list[str]:
    """Return the energies that the package minimises, the default first."""
    import typing

    import beltrami

    return list(typing.get_args(typing.get_type_hints(beltrami.Options)["energy"]))


def ours(vertices: np.ndarray, faces: np.ndarray, options: dict[str, Any]) -> dict[str, Any]:
    """Flatten with the package."""
    import beltrami

    result = beltrami.parameterize(vertices, faces, threads=1, **options)
    report = result.report
    stages: dict[str, list[float]] = {}
    for stage in result.stages:
        seconds, iterations = stages.get(stage.name, [0.0, 0])
        stages[stage.name] = [seconds + stage.cpu_seconds, iterations + stage.iterations]
    return {
        "uv": result.uv,
        "status": result.status,
        "certified": result.injective,
        "cpu_seconds": report.cpu_seconds,
        "seconds": report.seconds,
        "peak_bytes": report.peak_memory_bytes,
        "stages": stages,
        "boundary": report.boundary_edges,
        "coarse_faces": report.coarse_faces,
        "coarse_energy": report.coarse_energy,
        "flips_before": report.flips_before_repair,
        "repair": {
            key: getattr(report, key)
            for key in ("kernel_fixes", "patch_fixes", "global_fixes", "cleaned_patches")
        },
        "restarts": report.restarts,
    }


def slim(vertices: np.ndarray, faces: np.ndarray, _options: dict[str, Any]) -> dict[str, Any]:
    """Flatten with libigl's SLIM, until it gains less than CM would stop at."""
    import peers

    found = peers.run_slim(vertices, faces, TOLERANCE)
    return {"uv": found.uv, "cpu_seconds": found.cpu_seconds}


def lscm(vertices: np.ndarray, faces: np.ndarray, _options: dict[str, Any]) -> dict[str, Any]:
    """Flatten with libigl's least-squares conformal map, two far boundary vertices pinned."""
    import igl

    start = time.process_time()
    boundary = igl.boundary_loop(faces.astype(np.int64))
    away = np.linalg.norm(vertices[boundary] - vertices[boundary[0]], axis=1).argmax()
    pinned = np.array([boundary[0], boundary[away]], np.int64)
    ends = np.array([[0.0, 0.0], [1.0, 0.0]])
    uv, _ = igl.lscm(vertices, faces.astype(np.int64), pinned, ends)
    return {"uv": uv, "cpu_seconds": time.process_time() - start}


def scaf(vertices: np.ndarray, faces: np.ndarray, _options: dict[str, Any]) -> dict[str, Any]:
    """Flatten with libigl's SCAF."""
    import seams

    uv, seconds = seams.scaf(vertices, faces, RIVAL_ITERATIONS)
    return {"uv": uv, "cpu_seconds": seconds}


def blender(vertices: np.ndarray, faces: np.ndarray, _options: dict[str, Any]) -> dict[str, Any]:
    """Flatten with Blender's minimum stretch, its default iterations, into a chart of its own."""
    import bpy
    from blender_mesh import edited, uvs_of

    mesh = edited(vertices, faces)
    start = time.process_time()
    bpy.ops.uv.unwrap(method="MINIMUM_STRETCH", margin=0, correct_aspect=False)
    seconds = time.process_time() - start
    uv = np.zeros((len(vertices), 2))
    uv[faces.ravel()] = uvs_of(mesh, faces).reshape(-1, 2)
    return {"uv": uv, "cpu_seconds": seconds}


PROGRAMS: dict[str, Callable[[np.ndarray, np.ndarray, dict[str, Any]], dict[str, Any]]] = {
    "beltrami": ours,
    "LSCM": lscm,
    "SLIM": slim,
    "SCAF": scaf,
    "Blender": blender,
}


def at_best_scale(vertices: np.ndarray, faces: np.ndarray, uv: np.ndarray) -> np.ndarray:
    """Return a rival's UVs, whose scale is its own affair, at the scale of least energy."""
    from meshes import areas

    import beltrami

    used = areas(uv, faces)
    if used.sum() < 0:
        uv = uv * [-1, 1]
    uv = uv / np.sqrt(abs(used.sum()))
    singular = beltrami.distortion(vertices, faces, uv).singular_values
    sound = singular[:, 1] > 0
    weights = areas(vertices, faces)[sound, None]
    stretch, squeeze = ((weights * singular[sound] ** power).sum() for power in (2, -2))
    return np.ascontiguousarray(uv * (squeeze / stretch) ** 0.25)


def run(mesh: str, task: str, out: str) -> None:
    """Run one program on one mesh; the figures of the map appear, or the error."""
    values = json.loads(Path(task).read_text())
    program, options = values["program"], values["options"]
    most = int(time.process_time() + values["limit"]) + 1
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_CPU, (most, most + 5))
    with np.load(mesh) as read:
        vertices, faces = read["vertices"], read["faces"]
    warnings.simplefilter("ignore")  # the figures say it
    try:
        if program == "Blender":  # its interpreter need not have our package: only the map is kept
            found = blender(vertices, faces, options)
            np.savez(values["uv"], uv=found.pop("uv"))
        else:
            found = PROGRAMS[program](vertices, faces, options)
            found.update(finished(program, vertices, faces, found.pop("uv"), values))
    except Exception as error:  # of any program
        found = {
            "status": getattr(error, "status", type(error).__name__),
            "error": str(error)[:300],
        }
    found.setdefault("peak_bytes", resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024)
    Path(out).write_text(json.dumps(found))


def finished(
    program: str, vertices: np.ndarray, faces: np.ndarray, uv: np.ndarray, values: dict[str, Any]
) -> dict[str, Any]:
    """Measure a map, and keep its UVs where a picture is to show them."""
    found: dict[str, Any] = {}
    if program != "beltrami":
        if not np.isfinite(uv).all():
            return {"status": "FAILED", "error": "the UVs are not finite"}
        uv = at_best_scale(vertices, faces, uv)
        found["status"] = "OK"
    if values.get("keep"):
        np.savez_compressed(values["uv"], uv=uv)
    return {**found, **measure(vertices, faces, uv)}


def judge(mesh: str, made: str, task: str, out: str) -> None:
    """Measure UVs that another interpreter made."""
    found = json.loads(Path(out).read_text())
    if "error" in found:
        return
    with np.load(mesh) as read, np.load(made) as written:
        vertices, faces, uv = read["vertices"], read["faces"], written["uv"]
    values = json.loads(Path(task).read_text())
    found.update(finished(values["program"], vertices, faces, uv, values))
    Path(out).write_text(json.dumps(found))


def versions() -> None:
    """Print the versions of what is installed of the rivals."""
    found = {}
    for program, package in PACKAGES.items():
        try:
            found[program] = f"{package} {importlib.metadata.version(package)}"
        except importlib.metadata.PackageNotFoundError:
            continue
    print(json.dumps(found))


COMMANDS: dict[str, Callable[..., None]] = {
    "prepare": prepare,
    "run": run,
    "judge": judge,
    "versions": versions,
}

if __name__ == "__main__":
    COMMANDS[sys.argv[1]](*sys.argv[2:])
