"""Unwraps one mesh by one program, in a process of its own that may crash, hang or be stopped.

    atlas_programs.py PROGRAM MESH.npz OUT.npz OPTIONS SECONDS BYTES
    atlas_programs.py --versions

MESH.npz holds vertices (n, 3) and faces (m, 3). OUT.npz gets the UVs of the corners, the page that
they are on, and the CPU seconds of the call without imports and the copying of arrays; or the
error. OPTIONS are keywords as JSON, for ours alone. More than SECONDS of CPU time for the call, or
BYTES of memory, end the process. The rivals run with their default options, on one thread where
they can be told.
"""

from __future__ import annotations

import importlib
import importlib.metadata
import json
import math
import re
import resource
import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np

# Returns UVs of corners, (m, 3, 2) or (3 m, 2), and width and height of the page that they are in
# units of.
Call = Callable[[], tuple[np.ndarray, tuple[float, float]]]
SQUARE = (1.0, 1.0)


def ours(vertices: np.ndarray, faces: np.ndarray, options: dict[str, Any]) -> Call:
    """Prepare our unwrap; with ``cut="islands"`` and no UVs it is along the seams of xatlas."""
    import beltrami

    if options.get("cut") == "islands":
        options = {**options, "corner_uvs": xatlas(vertices, faces, {})()[0]}
    return lambda: (np.asarray(beltrami.unwrap(vertices, faces, **options).corner_uvs), SQUARE)


def xatlas(vertices: np.ndarray, faces: np.ndarray, _options: dict[str, Any]) -> Call:
    """Prepare xatlas."""
    import xatlas

    points, corners = vertices.astype(np.float32), faces.astype(np.uint32)

    def call() -> tuple[np.ndarray, tuple[float, float]]:
        atlas = xatlas.Atlas()
        atlas.add_mesh(points, corners)
        atlas.generate()
        _, indices, uvs = atlas[0]
        return np.asarray(uvs, float)[indices], (atlas.width, atlas.height)

    return call


def uvunwrap(vertices: np.ndarray, faces: np.ndarray, _options: dict[str, Any]) -> Call:
    """Prepare uvunwrap."""
    import uvunwrap

    mesh = uvunwrap.Mesh(vertices.astype(np.float32), faces.astype(np.uint32))

    def call() -> tuple[np.ndarray, tuple[float, float]]:
        atlas = uvunwrap.generate([mesh])
        return np.array(atlas.meshes[0].corner_uvs, float), (atlas.width, atlas.height)

    return call


def uvatlas(vertices: np.ndarray, faces: np.ndarray, _options: dict[str, Any]) -> Call:
    """Prepare Microsoft's UVAtlas, of open3d."""
    import open3d

    mesh = open3d.t.geometry.TriangleMesh(
        open3d.core.Tensor(vertices.astype(np.float32)),
        open3d.core.Tensor(faces.astype(np.int64)),
    )

    def call() -> tuple[np.ndarray, tuple[float, float]]:
        mesh.compute_uvatlas(nthreads=1)
        return np.asarray(mesh.triangle.texture_uvs.numpy(), float), SQUARE

    return call


def blender(vertices: np.ndarray, faces: np.ndarray, _options: dict[str, Any]) -> Call:
    """Prepare Blender's Smart UV Project."""
    import bpy
    from blender_mesh import edited, uvs_of

    mesh = edited(vertices, faces)

    def call() -> tuple[np.ndarray, tuple[float, float]]:
        bpy.ops.uv.smart_project()
        return uvs_of(mesh, faces), SQUARE

    return call


PROGRAMS = {
    "ours": ours,
    "xatlas": xatlas,
    "uvunwrap": uvunwrap,
    "UVAtlas": uvatlas,
    "Blender": blender,
}
# The packages that the rivals come in.
PACKAGES = {"xatlas": "xatlas", "uvunwrap": "uvunwrap", "UVAtlas": "open3d", "Blender": "bpy"}


def versions() -> dict[str, str]:
    """Return the versions of the rivals that are installed and load."""
    found = {}
    for program, package in PACKAGES.items():
        try:
            importlib.import_module(package)
        except ImportError:
            continue
        found[program] = f"{package} {importlib.metadata.version(package)}"
    return found


def limit(seconds: float, bytes_of_data: int) -> None:
    """Have the system end this process where it takes more, from now on."""
    most = math.ceil(time.process_time() + seconds)
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_CPU, (most, most + 5))
    resource.setrlimit(resource.RLIMIT_DATA, (bytes_of_data, bytes_of_data))


def short(message: str) -> str:
    """Return the end of the first line of a message, where open3d says what it is about."""
    plain = re.sub("\x1b\\[[0-9;]*m", "", message).strip()  # no colours
    return plain.splitlines()[0][-80:] if plain else ""


def main() -> None:
    """Run one program."""
    if sys.argv[1:] == ["--versions"]:
        print(json.dumps(versions()))
        return
    program, mesh, out, options, seconds, most = sys.argv[1:]
    with np.load(mesh) as read:
        vertices, faces = read["vertices"], read["faces"]
    try:
        call = PROGRAMS[program](vertices, faces, json.loads(options))
        limit(float(seconds), int(most))
        start = time.process_time()
        uvs, page = call()
        spent = time.process_time() - start
    except Exception as error:  # of any program
        np.savez(out, error=f"{type(error).__name__}: {short(str(error))}")
        return
    if uvs.size != 6 * len(faces):
        np.savez(out, error=f"gave {uvs.size // 2} UVs for {3 * len(faces)} corners")
        return
    np.savez(out, uvs=uvs.reshape(-1, 3, 2), page=page, seconds=spent)


if __name__ == "__main__":
    main()
