"""The examples run, each in a folder of its own."""

from __future__ import annotations

import subprocess
import sys

import pytest
from conftest import ROOT

EXAMPLES = {
    "flatten": ["hump.npz"],
    "compare_energies": ["energies.png"],
    "bake_checker": ["checker.png", "checker.mtl", "checker.obj"],
    "unwrap": ["boxes.npz"],
    "with_trimesh": ["cap.obj"],
}
FOLDER = ROOT / "bindings" / "python" / "examples"


def test_every_example_is_here():
    assert {path.stem for path in FOLDER.glob("*.py")} == EXAMPLES.keys()


@pytest.mark.parametrize("name", EXAMPLES)
def test_an_example_runs_and_writes_its_files(name, tmp_path):
    command = [sys.executable, "-B", FOLDER / f"{name}.py"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    for file in EXAMPLES[name]:
        assert (tmp_path / file).stat().st_size > 0
