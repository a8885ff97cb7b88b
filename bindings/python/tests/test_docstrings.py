"""Examples in docstrings: each public function has one, and all of them run as they stand."""

from __future__ import annotations

import doctest
import inspect
import tempfile

import pytest

import beltrami

# Outcomes, counts and kinds of arguments, which the calls that have them show.
PLAIN = (
    *(name for name in beltrami.__all__ if name.endswith(("Certificate", "Report", "Options"))),
    *("AtlasCheck", "Baked", "BatchRecord", "Chart", "Distortion", "Energy", "Packing", "Stage"),
    *("Changes", "SessionChart", "Triangulation", "build_info", "plot", "xatlas"),
)


def shown():
    """Yield what is to have an example, by its name."""
    for name in sorted(set(beltrami.__all__) - set(PLAIN)):
        thing = getattr(beltrami, name)
        is_error = inspect.isclass(thing) and issubclass(thing, (Exception, Warning))
        if not is_error or thing is beltrami.BeltramiError:
            yield name, thing
    for name in ("atlas", "checkered", "heat_map", "layout"):
        yield f"plot.{name}", getattr(beltrami.plot, name)


@pytest.mark.parametrize(("name", "thing"), list(shown()))
def test_an_example_runs_as_it_stands(name, thing, tmp_path, monkeypatch):
    if name.startswith("plot."):
        pytest.importorskip("matplotlib").use("Agg")
    if name == "SceneAtlases":
        pytest.importorskip("trimesh")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    finder, runner = doctest.DocTestFinder(), doctest.DocTestRunner()
    for test in finder.find(thing, name, globs={"beltrami": beltrami}):
        runner.run(test)
    assert runner.tries > 0
    assert runner.failures == 0
