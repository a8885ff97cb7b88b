"""The package as such: names, documentation, the program, what it leaves alone."""

from __future__ import annotations

import importlib.metadata
import inspect
import re
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import ROOT

import beltrami

HERE = ROOT / "bindings" / "python"
PACKAGE = Path(beltrami.__file__).parent


def public_names():
    """Yield every public name, with those inside classes: (name, thing)."""
    for name in beltrami.__all__:
        thing = getattr(beltrami, name)
        yield name, thing
        members = []
        if inspect.ismodule(thing):
            members = thing.__all__
        elif inspect.isclass(thing):
            fields = getattr(thing, "__dataclass_fields__", ())
            members = [member for member in {*vars(thing), *fields} if not member.startswith("_")]
        for member in members:
            yield f"{name}.{member}", getattr(thing, member, None)


NAMES = dict(public_names())


def is_documented_elsewhere(name):
    """Whether it is a field of a class of results, which the class's own text describes."""
    owner, _, member = name.partition(".")
    of_field = re.compile(rf"^    (\w+, )*{member}(, \w+)* : ", re.M)
    return any(of_field.search(cls.__doc__ or "") for cls in getattr(NAMES[owner], "__mro__", ()))


def test_the_names_are_those_that_are_imported():
    public = {name for name in vars(beltrami) if not name.startswith("_")}
    assert public == set(beltrami.__all__)
    assert len(NAMES) > 100


@pytest.mark.parametrize("name", NAMES)
def test_every_public_name_is_documented(name):
    thing = NAMES[name]
    if "." in name and is_documented_elsewhere(name):
        return
    assert inspect.getdoc(thing), name
    if not inspect.isroutine(thing) or thing.__name__.startswith("_"):
        return
    text, signature = inspect.getdoc(thing), inspect.signature(thing)
    parameters = [name for name in signature.parameters if name != "self"]
    for parameter in parameters:
        assert re.search(rf"^(\w+, )*(\*\*)?{parameter}(, \w+)*( : |$)", text, re.M), parameter
    if parameters:
        assert "Raises\n------" in text
        assert signature.return_annotation in ("None", None) or "Returns\n-------" in text


def arrays_of(thing):
    """Yield the parameters and the fields that are arrays."""
    if inspect.isclass(thing):
        for name, kind in vars(thing).get("__annotations__", {}).items():
            if kind == "Array":
                yield name
    elif callable(thing):
        for name, parameter in inspect.signature(thing).parameters.items():
            if "ArrayLike" in str(parameter.annotation) or name == "vertices":
                yield name


def test_arrays_are_documented_with_shapes_and_types():
    described = 0
    for name, thing in NAMES.items():
        text = inspect.getdoc(thing) or ""
        for array in arrays_of(thing):
            if name == "Flattener.parameterize":
                assert "As for `set_mesh`." in text
                continue
            if array in ("face_labels", "materials"):
                continue  # of anything
            if array == "pins":
                pair = "tuple of (k,) array_like of integers and (k, 2) array_like of floats"
                assert f"pins : {pair}" in text
                continue
            if array == "straight":
                pair = "tuple of (k, 2) array_like of integers and sequence of str"
                assert f"straight : {pair}" in text
                continue
            if array == "edge_paint":
                pair = "tuple of (k, 2) array_like of integers and (k,) array_like of floats"
                assert f"edge_paint : {pair}" in text
                continue
            if array == "images":  # of the type and channels of those that were given
                assert re.search(r"^images : (.* array|array_like, or sequence)", text, re.M)
                continue
            shape = (
                r"\((n, [23]|n,|m, 3|m, 2|m,|3,|[mtks], [23k]|[kcpm],|m, k, 2|[ms], 3, [234]|t,)\) "
            )
            shape += r"array(_like)? of (floats|integers|(float|u?int)\d\d)"
            names = rf"([a-z_]+, )*{array}(, [a-z_]+)*"
            assert re.search(rf"^{names} : {shape}", text, re.M), (name, array)
            described += 1
        if isinstance(thing, property) and thing.fget.__annotations__["return"] == "Array":
            shape = (
                r"An? \((m,|k, 2|t,|t, 3|m, k, 2)\) array of (bool|float64|int64|floats|integers): "
            )
            assert re.match(shape, text), name
            described += 1
    assert described > 25


def test_every_option_is_a_keyword_with_its_default():
    library = beltrami._library
    flattening = (beltrami.parameterize, beltrami.Flattener, beltrami.batch)
    unwrapping = (beltrami.unwrap, beltrami.unwrap_batch)
    for call, functions in ((library.RUN, flattening), (library.UNWRAP, unwrapping)):
        table = library.options_of(call)
        for function in functions:
            parameters = inspect.signature(function).parameters
            assert set(table) <= set(parameters)
            assert not set(library._OPTIONS) - set(table) & set(parameters)
            for name in table:
                assert parameters[name].kind is inspect.Parameter.KEYWORD_ONLY
    table = library.options_of(library.RUN)
    assert beltrami.Options.__annotations__.keys() == table.keys()
    assert beltrami.Flattener().options.keys() == table.keys()
    table = library.options_of(library.UNWRAP)
    assert beltrami.UnwrapOptions.__annotations__.keys() == table.keys()
    table = library.options_of(library.PACK)
    assert set(table) <= set(inspect.signature(beltrami.pack).parameters)
    assert beltrami.PackOptions.__annotations__.keys() == table.keys()


def test_generated_sources_are_what_the_c_interface_says():
    library = PACKAGE / "libbeltrami.so.1"
    generate = [sys.executable, "-B", HERE / "tools" / "generate.py", "--check"]
    subprocess.run([*generate, "--library", library], check=True)


def test_the_package_is_that_of_this_checkout():
    for path in (HERE / "src" / "beltrami").glob("*.py*"):
        assert (PACKAGE / path.name).read_bytes() == path.read_bytes(), path.name


def test_the_version_is_the_librarys():
    assert beltrami.__version__ == importlib.metadata.version("beltrami")
    assert f"beltrami {beltrami.__version__}," in beltrami.build_info()


def test_the_package_needs_little_and_holds_no_gpl_code():
    assert "links no GPL code" in beltrami.build_info()
    needs = importlib.metadata.requires("beltrami")
    assert {re.split(r"[^\w]", need)[0] for need in needs if "extra ==" not in need} == {
        "cffi",
        "numpy",
    }


def test_the_wheel_runs_on_systems_with_glibc_2_28_and_brings_no_library_but_its_own():
    package = importlib.metadata.distribution("beltrami")
    tags = re.findall(r"^Tag: .*-manylinux_2_(\d+)_x86_64$", package.read_text("WHEEL"), re.M)
    assert tags
    assert min(map(int, tags)) <= 28
    libraries = {file.name for file in package.files if ".so" in file.name}
    assert libraries == {"_native.abi3.so", "libbeltrami.so.1"}


def test_importing_leaves_everything_as_it_was():
    program = """
import os, signal, sys, threading
before = dict(os.environ), signal.getsignal(signal.SIGINT), threading.active_count()
import numpy
import beltrami
assert (dict(os.environ), signal.getsignal(signal.SIGINT), threading.active_count()) == before
optional = {"matplotlib", "trimesh", "distributed", "dask", "tqdm", "typing_extensions"}
assert not optional & set(sys.modules), optional & set(sys.modules)
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


@pytest.mark.parametrize(
    "command",
    [[sys.executable, "-m", "beltrami"], [Path(sys.executable).with_name("beltrami")]],
    ids=["python -m beltrami", "beltrami"],
)
def test_the_program_comes_with_the_package(command, tmp_path):
    done = subprocess.run([*command, "--version"], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == beltrami.build_info()
    done = subprocess.run([*command, "flatten"], capture_output=True, text=True)
    assert done.returncode == 2
    assert "IN is required" in done.stderr


def test_types_are_marked():
    assert (PACKAGE / "py.typed").exists()
