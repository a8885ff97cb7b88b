"""Packs charts by one rival, in the interpreter that has it.

    pack_rivals.py PROGRAM CHARTS.npz OUT.npz RESOLUTION MARGIN
    pack_rivals.py --programs

CHARTS.npz holds UVs (k, 2) and faces (m, 3). OUT.npz gets the UVs of the corners (m, 3, 2), a page
being the unit square, and the CPU seconds of the call; nothing where it takes more than a page.
"""

from __future__ import annotations

import importlib
import json
import sys
import time

import numpy as np

# UVs of corners and seconds.
Packed = tuple[np.ndarray, float]


def blender(uvs: np.ndarray, faces: np.ndarray, resolution: int, margin: float) -> Packed:
    """Pack by Blender's exact shapes, at any angle: each chart has half the margin about it."""
    import bpy
    from blender_mesh import edited, uvs_of

    mesh = edited(np.pad(uvs, ((0, 0), (0, 1))), faces, uvs)
    bpy.ops.uv.select_all(action="SELECT")
    start = time.process_time()
    bpy.ops.uv.pack_islands(
        shape_method="CONCAVE",
        rotate=True,
        rotate_method="ANY",
        scale=True,
        merge_overlap=False,
        margin_method="FRACTION",
        margin=margin / 2 / resolution,
    )
    seconds = time.process_time() - start
    return uvs_of(mesh, faces), seconds


def uvunwrap(uvs: np.ndarray, faces: np.ndarray, resolution: int, margin: float) -> Packed:
    """Pack the charts of UVs that uvunwrap is given with the mesh."""
    import uvunwrap

    plane = np.pad(uvs, ((0, 0), (0, 1))).astype(np.float32)
    mesh = uvunwrap.Mesh(plane, faces.astype(np.uint32), existing_uvs=uvs.astype(np.float32))
    start = time.process_time()
    atlas = uvunwrap.generate([mesh], page_size=resolution, padding=round(margin))
    seconds = time.process_time() - start
    if atlas.page_count != 1:
        raise ValueError("more than one page")
    # The page may be lower than it is wide: the square around it counts.
    packed = np.array(atlas.meshes[0].corner_uvs, float).reshape(-1, 3, 2)
    return packed * [atlas.width, atlas.height] / max(atlas.width, atlas.height), seconds


PROGRAMS = {"Blender": (blender, "bpy"), "uvunwrap": (uvunwrap, "uvunwrap")}


def installed(package: str) -> bool:
    """Return whether a package loads."""
    try:
        importlib.import_module(package)
    except ImportError:
        return False
    return True


def main() -> None:
    """Run one program."""
    if sys.argv[1:] == ["--programs"]:
        print(json.dumps([name for name, (_, package) in PROGRAMS.items() if installed(package)]))
        return
    program, charts, out, resolution, margin = sys.argv[1:]
    with np.load(charts) as read:
        uvs, faces = read["uvs"], read["faces"]
    try:
        packed, seconds = PROGRAMS[program][0](uvs, faces, int(resolution), float(margin))
    except (ValueError, RuntimeError) as error:
        print(f"{program}: {error}", file=sys.stderr)
        return
    np.savez(out, uvs=packed, seconds=seconds)


if __name__ == "__main__":
    main()
