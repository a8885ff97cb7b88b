"""Memory: none is lost, and none is spent on copies."""

from __future__ import annotations

import ctypes
import gc
import sys
import tracemalloc

import numpy as np
import pytest
from conftest import grid

import beltrami


class MallocInfo(ctypes.Structure):
    """``struct mallinfo2`` of the C library."""

    _names = ("arena", "ordblks", "smblks", "hblks", "hblkhd", "usmblks", "fsmblks", "uordblks")
    _fields_ = [(name, ctypes.c_size_t) for name in (*_names, "fordblks", "keepcost")]


def held():
    """Return the bytes that malloc has handed out, and the blocks that Python's objects have."""
    mallinfo2 = ctypes.CDLL(None).mallinfo2
    mallinfo2.restype = MallocInfo
    gc.collect()
    info = mallinfo2()
    return info.uordblks + info.hblkhd, sys.getallocatedblocks()


def everything(vertices, faces):
    """Call all that keeps memory on the other side, and what fails there."""
    result = beltrami.parameterize(vertices, faces, progress=lambda *_: None)
    beltrami.check_injective(result.uv, faces)
    beltrami.distortion(vertices, faces, result.uv)
    with pytest.raises(beltrami.IndexOutOfRangeError):
        beltrami.parameterize(vertices, faces + 1)
    with pytest.raises(beltrami.Cancelled):
        beltrami.parameterize(vertices, faces, progress=lambda *_: False)


def test_memory_does_not_grow_over_a_thousand_runs():
    vertices, faces = grid(6)
    for _ in range(200):
        everything(vertices, faces)
    bytes_before, blocks_before = held()
    for _ in range(1000):
        everything(vertices, faces)
    bytes_after, blocks_after = held()
    assert bytes_after - bytes_before < 1000 * 100
    assert blocks_after - blocks_before < 1000 * 10


@pytest.mark.parametrize("wide", [False, True])
def test_a_large_mesh_goes_in_without_a_copy(wide):
    vertices, faces = grid(708)  # a million faces
    if wide:
        vertices = np.hstack([vertices, vertices])[:, :3]
        faces = np.hstack([faces, faces])[:, 3:]
    flattener = beltrami.Flattener()
    tracemalloc.start()
    flattener.set_mesh(vertices, faces)
    flattener.cancel()  # what matters here is the way in
    with pytest.raises(beltrami.Cancelled):
        flattener.run()
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 100_000  # the arrays have 12 MB and 24 MB
