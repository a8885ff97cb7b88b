"""The numbers are those of the C interface and of the program, to the last bit."""

from __future__ import annotations

import ctypes
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, grid, read_obj, write_obj

import beltrami

F32, F64, U32 = 0, 1, 2
OPTIONS = [
    {},
    {"energy": "symmetric-arap", "unit_square": True},
    {"energy": "exponential-dirichlet", "coarse_faces": 60},
    {"method": "tutte"},
    {"flatten": "dirichlet", "coarse_faces": 60, "threads": 2},
    {"delaunay": True, "float32": True},
    {"refine": True, "refine_iterations": 3, "tolerance": 1e-7, "injectivity": "local"},
]
LIBRARIES = {
    "of the package": Path(beltrami.__file__).parent / "libbeltrami.so.1",
    "of the build": ROOT / "build" / "release" / "src" / "libbeltrami.so",
}


class Buffer(ctypes.Structure):
    _fields_ = [
        ("data", ctypes.c_void_p),
        ("stride", ctypes.c_uint64),
        ("type", ctypes.c_int32),
        ("reserved", ctypes.c_uint32),
    ]


class Mesh(ctypes.Structure):
    _fields_ = [
        ("struct_size", ctypes.c_uint32),
        ("flags", ctypes.c_uint32),
        ("vertex_count", ctypes.c_uint64),
        ("face_count", ctypes.c_uint64),
        ("positions", Buffer),
        ("indices", Buffer),
    ]


def set_option(c, context, name, value):
    key = c.beltrami_option_find(name.replace("_", "-").encode())
    if isinstance(value, str):
        c.beltrami_option_choice.restype = ctypes.c_char_p
        value = next(i for i in range(9) if c.beltrami_option_choice(key, i).decode() == value)
    if isinstance(value, float):
        assert c.beltrami_set_float(context, key, ctypes.c_double(value)) == 0
    else:
        assert c.beltrami_set_int(context, key, ctypes.c_int64(value)) == 0


def flatten_in_c(library, vertices, faces, options):
    """Return the UVs that a client of the C interface gets."""
    c = ctypes.CDLL(str(library))
    context = ctypes.c_void_p()
    assert c.beltrami_create_(1, ctypes.byref(context)) == 0
    for name, value in options.items():
        set_option(c, context, name, value)
    faces = faces.astype(np.uint32)
    scalar = F32 if vertices.dtype == np.float32 else F64
    mesh = Mesh(ctypes.sizeof(Mesh), 0, len(vertices), len(faces))
    mesh.positions = Buffer(vertices.ctypes.data, 0, scalar, 0)
    mesh.indices = Buffer(faces.ctypes.data, 0, U32, 0)
    assert c.beltrami_set_mesh(context, ctypes.byref(mesh)) == 0
    assert c.beltrami_run(context, None, None) >= 0
    uv = np.empty((len(vertices), 2), np.float32 if options.get("float32") else vertices.dtype)
    scalar = F32 if uv.dtype == np.float32 else F64
    out = ctypes.c_void_p(uv.ctypes.data)
    assert c.beltrami_get_uvs(context, out, scalar, ctypes.c_uint64(0)) == 0
    c.beltrami_destroy(context)
    return uv


@pytest.mark.parametrize("library", LIBRARIES)
@pytest.mark.parametrize("options", OPTIONS, ids=str)
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_the_uvs_are_those_of_the_c_interface(library, options, dtype):
    vertices, faces = grid(20)
    vertices = vertices.astype(dtype)
    expected = flatten_in_c(LIBRARIES[library], vertices, faces, options)
    result = beltrami.parameterize(vertices, faces, **options)
    assert result.uv.dtype == expected.dtype
    assert result.uv.tobytes() == expected.tobytes()


@pytest.mark.parametrize(
    "options", [{}, {"coarse_faces": 500, "energy": "symmetric-arap"}], ids=str
)
def test_the_uvs_are_those_that_the_program_writes(bust, tmp_path, options):
    flags = [f"--{name.replace('_', '-')}={value}" for name, value in options.items()]
    source, target = write_obj(tmp_path / "in.obj", *bust), tmp_path / "out.obj"
    program = [sys.executable, "-m", "beltrami", "flatten", "--quiet", *flags]
    subprocess.run([*program, source, target], check=True)
    expected = beltrami.parameterize(*bust, **options).uv
    assert read_obj(target)[1].tobytes() == expected.tobytes()


def test_the_number_of_threads_does_not_matter(bust):
    one, two = (beltrami.parameterize(*bust, threads=threads) for threads in (1, 2))
    assert one.uv.tobytes() == two.uv.tobytes()
