# SPDX-FileCopyrightText: 2026 The beltrami authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Work in threads, and the options that operators show."""

from __future__ import annotations

import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest
from uv_logic import settings
from uv_logic.jobs import Job, end_all, part_of

import beltrami

PATIENCE = 30  # seconds after which what waits has failed
TOOLS = Path(__file__).resolve().parents[2] / "tools"


def test_a_job_tells_how_far_it_is_and_hands_out_its_result():
    go_on = threading.Event()

    def work(progress):
        assert progress(0.25, "half way to half way")
        go_on.wait(PATIENCE)
        progress(1.0, "end")
        return 42

    job = Job(work).start()
    while job.fraction == 0 and not job.done:
        job.wait(0.001)
    assert job.fraction == 0.25
    assert job.stage == "half way to half way"
    assert not job.done
    go_on.set()
    assert job.wait(PATIENCE)
    assert job.result() == 42
    assert job.fraction == 1


def test_a_cancelled_run_of_the_library_ends():
    vertices = np.random.default_rng(1).normal(size=(2000, 3))
    faces = np.arange(1998)[:, None] + np.arange(3)
    began = threading.Event()

    def work(progress):
        def told(fraction, stage):
            began.set()
            return progress(fraction, stage)

        return beltrami.unwrap(vertices, faces, progress=told)

    job = Job(work)
    job.cancel()
    job.start()
    assert job.wait(PATIENCE)
    assert began.is_set()
    with pytest.raises(beltrami.Cancelled):
        job.result()


def test_all_work_can_be_ended():
    began = threading.Event()

    def work(progress):
        while progress(0.5, "on and on"):
            began.set()

    jobs = [Job(work).start() for _ in range(2)]
    assert began.wait(PATIENCE)
    assert end_all(PATIENCE)
    assert all(job.done for job in jobs)


def test_what_work_raises_comes_out_with_the_result():
    job = Job(lambda progress: 1 / 0).start()
    with pytest.raises(ZeroDivisionError):
        job.result()


def test_fractions_of_parts_are_parts():
    told = []
    part = part_of(lambda fraction, stage: told.append(fraction) is None, 0.5, 0.25)
    assert part(0.0, "")
    assert part(1.0, "")
    assert told == [0.5, 0.75]


def test_defaults_are_left_to_the_library():
    values = {name: settings.TABLE[name].default for name in settings.AUTO_OPTIONS}
    assert settings.given(values, "unwrap") == {}
    single = {"target_energy": float(np.float32(2.1)), "fill_holes": 0.5, "effort": "quick"}
    assert settings.given(single, "unwrap") == {"target_energy": 2.1, "effort": "quick"}
    assert settings.given({"margin": 4.0, "effort": "quick"}, "pack") == {"margin": 4.0}
    least = {"target_energy": float(np.float32(2.0001))}  # below the least there is
    assert settings.given(least, "unwrap") == {"target_energy": 2.0001}


@pytest.mark.parametrize("name", sorted({*settings.UNWRAP_OPTIONS, *settings.AUTO_OPTIONS}))
def test_what_operators_show_is_what_the_library_has(name):
    shown = settings.property_of(name)
    assert shown.option.unwraps
    assert shown.label
    if shown.option.kind in ("int", "float"):
        assert shown.option.minimum <= shown.soft[0] < shown.soft[1] <= shown.option.maximum
    elif shown.option.kind == "choice":
        assert shown.option.default in shown.option.choices


def test_the_table_of_options_is_the_librarys():
    library = Path(beltrami.__file__).parent / "libbeltrami.so.1"
    generate = [sys.executable, "-B", TOOLS / "generate.py", "--check", "--library", library]
    subprocess.run(generate, check=True)
