"""The snippets of the guides run as they stand."""

from __future__ import annotations

import doctest
import inspect
import re
import sys
import warnings
from pathlib import Path

import pytest
from conftest import ROOT, grid

import beltrami

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")
pyplot = pytest.importorskip("matplotlib.pyplot")


def snippets(guide: str) -> list[tuple[int, str]]:
    """Return the blocks of Python in a guide, each with the line above its first."""
    text = (ROOT / guide).read_text()
    blocks = re.finditer(r"^```python\n(.*?)^```$", text, re.M | re.S)
    return [(text.count("\n", 0, block.start(1)), block[1]) for block in blocks]


@pytest.fixture
def _folder(tmp_path, monkeypatch):
    """Work in a folder that has what the guides read."""
    trimesh = pytest.importorskip("trimesh")
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    (tmp_path / "scans").mkdir()
    for rows in (5, 6):
        mesh = trimesh.Trimesh(*grid(rows), process=False)
        mesh.export(tmp_path / "scans" / f"hump{rows}.ply")
    monkeypatch.chdir(tmp_path)
    known = sys.modules.get("xatlas")  # a guide puts ours in its place
    yield
    sys.modules.pop("xatlas", None)
    if known is not None:
        sys.modules["xatlas"] = known
    pyplot.close("all")


def is_imported(value: object) -> bool:
    """Whether it is what an import leaves behind."""
    return inspect.ismodule(value) or inspect.isroutine(value)


def run(guide: str) -> dict[str, object]:
    """Run the snippets one after the other; return all that they have left behind."""
    data: dict[str, object] = {}
    for line, code in snippets(guide):
        names = dict(data)
        with warnings.catch_warnings():  # a snippet may set filters
            exec(compile("\n" * line + code, ROOT / guide, "exec"), names)
        # The next one has its own imports.
        data = {name: value for name, value in names.items() if not is_imported(value)}
    return data


@pytest.mark.usefixtures("_folder")
@pytest.mark.parametrize("guide", ["README.md", "bindings/python/README.md"])
def test_the_snippets_of_a_readme_run_as_they_stand(guide):
    assert run(guide)["result"].injective


@pytest.mark.usefixtures("_folder")
def test_the_snippets_of_the_guide_run_one_after_the_other():
    data = run("docs/python.md")
    assert data["result"].injective
    assert Path("flat.obj").read_text().count("\nvt ") == len(data["mesh"].vertices)
    assert data["found"].singular_values.shape == (2, 2)
    assert [record.ok for record in data["records"]] == [True, True]
    assert Path("checkered.png").stat().st_size > 0


def test_the_snippet_of_the_package_runs_as_it_stands():
    results = doctest.testmod(beltrami)
    assert results.attempted >= 5
    assert results.failed == 0
