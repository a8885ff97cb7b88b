"""The token that ends calls from any thread."""

from __future__ import annotations

import signal
import threading

import numpy as np
import pytest
from conftest import grid

import beltrami

CUBE = (
    np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], float),
    [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]],
)
UV_MESH = beltrami.UvMesh(np.array([[0.0, 0], [1, 0], [0, 1]]), np.array([[0, 1, 2]]))
TRIANGLE = np.array([[[0.0, 0], [1, 0], [0, 1]]])


def calls(folder):
    """Return calls that take a token, by name."""
    unwrapped = beltrami.unwrap(*CUBE).corner_uvs
    image = np.zeros((4, 4), np.uint8)
    (folder / "cube.off").write_text(
        "OFF\n8 6 0\n"
        + "".join(f"{x} {y} {z}\n" for x, y, z in CUBE[0])
        + "".join(f"4 {' '.join(map(str, face))}\n" for face in CUBE[1])
    )
    files = [folder / "cube.off"]
    return {
        "unwrap": lambda token: beltrami.unwrap(*CUBE, cancel=token),
        "parameterize": lambda token: beltrami.parameterize(*grid(8), cancel=token),
        "pack": lambda token: beltrami.pack(UV_MESH, cancel=token),
        "bake": lambda token: beltrami.bake(image, TRIANGLE, TRIANGLE, resolution=8, cancel=token),
        "check_atlas": lambda token: beltrami.check_atlas(*CUBE, unwrapped, cancel=token),
        "batch": lambda token: beltrami.batch(files, folder / "flat", cancel=token),
        "unwrap_batch": lambda token: beltrami.unwrap_batch(files, folder / "out", cancel=token),
    }


NAMES = ["unwrap", "parameterize", "pack", "bake", "check_atlas", "batch", "unwrap_batch"]


@pytest.mark.parametrize("name", NAMES)
def test_a_token_that_is_cancelled_ends_a_call_at_once(name, tmp_path):
    token = beltrami.CancelToken()
    call = calls(tmp_path)[name]
    assert call(token) is not None
    assert not token.cancelled
    token.cancel()
    assert token.cancelled
    for _ in range(2):  # it stays cancelled
        with pytest.raises(beltrami.Cancelled) as caught:
            call(token)
        assert caught.value.status == "BELTRAMI_E_CANCELLED"
        assert caught.value.code == -6


@pytest.mark.parametrize("name", NAMES)
def test_other_things_than_tokens_are_refused(name, tmp_path):
    with pytest.raises(TypeError, match=r"cancel is 'stop': give a beltrami\.CancelToken"):
        calls(tmp_path)[name]("stop")


@pytest.mark.parametrize("call", [beltrami.unwrap, beltrami.parameterize])
def test_a_call_under_way_is_ended_from_another_thread(call):
    token, running, reports = beltrami.CancelToken(), threading.Event(), []

    def meddle():
        running.wait()
        token.cancel()

    def progress(_fraction, _stage):
        running.set()
        thread.join()  # so that no time decides
        reports.append(token.cancelled)

    thread = threading.Thread(target=meddle)
    thread.start()
    with pytest.raises(beltrami.Cancelled):
        call(*grid(40), cancel=token, progress=progress)
    assert reports == [True]


def test_a_token_ends_all_calls_that_have_it():
    token, meeting, outcomes = beltrami.CancelToken(), threading.Barrier(4), []

    def work():
        with pytest.raises(beltrami.Cancelled):
            beltrami.unwrap(*grid(30), cancel=token, progress=progress)
        outcomes.append("cancelled")

    def progress(_fraction, _stage):
        if not token.cancelled:
            meeting.wait()
            meeting.wait()  # until it is cancelled

    threads = [threading.Thread(target=work) for _ in range(3)]
    for thread in threads:
        thread.start()
    meeting.wait()
    token.cancel()
    meeting.wait()
    for thread in threads:
        thread.join()
    assert outcomes == 3 * ["cancelled"]


def test_a_token_that_is_not_cancelled_changes_nothing():
    token = beltrami.CancelToken()
    plain = beltrami.unwrap(*CUBE)
    for _ in range(2):
        assert beltrami.unwrap(*CUBE, cancel=token).uvs.tobytes() == plain.uvs.tobytes()
    token.check()


def test_a_signal_handler_may_cancel():
    token = beltrami.CancelToken()
    before = signal.signal(signal.SIGINT, lambda *_: token.cancel())
    try:
        with pytest.raises(beltrami.Cancelled):
            beltrami.unwrap(
                *grid(40), cancel=token, progress=lambda *_: signal.raise_signal(signal.SIGINT)
            )
    finally:
        signal.signal(signal.SIGINT, before)


def test_the_meshes_of_a_scene_are_ended_by_one_token():
    trimesh = pytest.importorskip("trimesh")
    scene = trimesh.Scene([trimesh.creation.box(), trimesh.creation.icosphere(1)])
    token, stages = beltrami.CancelToken(), []

    def progress(fraction, stage):
        stages.append(stage)
        if fraction >= 0.9:  # the meshes are done, and are packed
            token.cancel()

    with pytest.raises(beltrami.Cancelled):
        beltrami.unwrap(scene, share_page=True, cancel=token, progress=progress)
    assert stages


def test_loops_of_ones_own_ask_a_token():
    token = beltrami.CancelToken()
    token.check()
    token.cancel()
    with pytest.raises(beltrami.Cancelled, match="by its token"):
        token.check()
