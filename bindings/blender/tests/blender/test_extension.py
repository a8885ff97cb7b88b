# SPDX-FileCopyrightText: 2026 The beltrami authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension as such: its zip, its properties, its windows and menus, threads and Esc."""

from __future__ import annotations

import subprocess
import sys
import threading
import zipfile
from pathlib import Path
from types import SimpleNamespace

import pytest
from conftest import MODULE, ZIP, bpy

HERE = Path(__file__).resolve().parents[2]
PATIENCE = 30  # seconds after which what waits has failed
OPERATORS = (
    "beltrami_unwrap",
    "beltrami_auto",
    "beltrami_straighten",
    "beltrami_pack",
    "beltrami_check",
)


def test_blender_finds_the_zip_valid():
    tools = list(Path(bpy.utils.resource_path("LOCAL")).rglob("blender_ext.py"))
    if not tools:
        pytest.skip("this Blender comes without its tool for extensions, blender_ext.py")
    validate = [sys.executable, str(tools[0]), "validate", str(ZIP)]
    done = subprocess.run(validate, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_zip_has_the_sources_their_licence_and_the_wheels():
    with zipfile.ZipFile(ZIP) as archive:
        names = archive.namelist()
        for path in (HERE / "extension").rglob("*.py"):
            name = path.relative_to(HERE / "extension").as_posix()
            assert archive.read(name) == path.read_bytes(), name
        assert archive.read("LICENSE") == (HERE / "LICENSE").read_bytes()
        wheels = [name for name in names if name.endswith(".whl")]
        assert sorted(Path(name).name.split("-")[0] for name in wheels) == ["beltrami", "cffi"]
        manifest = archive.read("blender_manifest.toml").decode()
        assert all(f'"./{name}"' in manifest for name in wheels)


def test_the_zip_is_the_same_each_time(tmp_path):
    with zipfile.ZipFile(ZIP) as archive:
        archive.extractall(tmp_path / "old")
    wheels = sorted((tmp_path / "old" / "wheels").iterdir())
    build = [sys.executable, "-B", HERE / "tools" / "build.py", "--out", tmp_path]
    done = subprocess.run(
        [*build, "--wheel", wheels[0], "--cffi", wheels[1]], capture_output=True, check=True
    )
    assert Path(done.stdout.decode().strip()).read_bytes() == ZIP.read_bytes()


def test_all_files_name_their_licence():
    for path in HERE.rglob("*"):
        if path.suffix in (".py", ".toml", ".sh") and "__pycache__" not in path.parts:
            head = path.read_text(encoding="utf-8")[:300]
            assert "SPDX-License-Identifier: GPL-3.0-or-later" in head, path


def test_operators_have_the_options_of_the_library(scene, installed):
    for name, options in (
        ("beltrami_unwrap", installed.settings.UNWRAP_OPTIONS),
        ("beltrami_auto", installed.settings.AUTO_OPTIONS),
        ("beltrami_straighten", installed.settings.STRAIGHTEN_OPTIONS),
        ("beltrami_pack", installed.settings.PAGE_OPTIONS),
    ):
        properties = getattr(scene.ops.uv, name).get_rna_type().properties
        for option in options:
            held = properties[option]
            of_library = installed.settings.TABLE[option]
            assert held.default == pytest.approx(of_library.default), option
            assert held.description
            if of_library.kind == "choice":
                assert tuple(held.enum_items.keys()) == of_library.choices
            elif of_library.kind in ("int", "float"):
                assert held.hard_min == pytest.approx(of_library.minimum)


def test_it_can_be_disabled_and_enabled(scene, installed):
    assert scene.types.VIEW3D_MT_uv_map.draw._draw_funcs.count(installed.panels.draw_menu) == 1
    scene.ops.preferences.addon_disable(module=MODULE)
    assert not hasattr(scene.types.Scene, "beltrami")
    assert installed.panels.draw_menu not in scene.types.IMAGE_MT_uvs.draw._draw_funcs
    with pytest.raises((AttributeError, KeyError)):
        scene.ops.uv.beltrami_check.get_rna_type()
    scene.ops.preferences.addon_enable(module=MODULE)
    assert scene.ops.uv.beltrami_check.get_rna_type() is not None


class Layout:
    """A layout that remembers what was drawn, and refuses what is not there."""

    def __init__(self):
        self.drawn = []

    def prop(self, holder, name, **_):
        assert name in holder.bl_rna.properties, name
        self.drawn.append(name)

    def operator(self, name, **_):
        self.drawn.append(name)
        kind = getattr(bpy.ops.uv, name.split(".")[1]).get_rna_type()
        return SimpleNamespace(bl_rna=kind)

    def label(self, text):
        self.drawn.append(text)

    def progress(self, factor, text):
        self.drawn.append((factor, text))

    def menu(self, name):
        assert hasattr(bpy.types, name)
        self.drawn.append(name)

    def separator(self):
        pass

    def box(self):
        return self

    def column(self):
        return self


def drawn(cls, **given):
    layout = Layout()
    cls.draw(SimpleNamespace(layout=layout, names=getattr(cls, "names", ()), **given), bpy.context)
    return layout.drawn


def test_panels_and_menus_show_what_there_is(scene, installed):
    panels = installed.panels
    shown = drawn(panels.IMAGE_PT_beltrami, _button=lambda *_: None)
    assert {"target_energy", "preset", "effort", "cut"} <= set(shown)
    for section in (panels.IMAGE_PT_beltrami_pages, panels.IMAGE_PT_beltrami_seams):
        assert drawn(section)
    assert drawn(panels.UV_MT_beltrami) == [f"uv.{name}" for name in OPERATORS]
    layout = Layout()
    held = SimpleNamespace(layout=layout)
    names = ("keep_pins", *installed.settings.UNWRAP_OPTIONS)
    cls, of_scene = installed.operators.UV_OT_beltrami_unwrap, scene.context.scene.beltrami
    panels.IMAGE_PT_beltrami._button(held, cls, "Unwrap", names, of_scene)
    assert layout.drawn == ["uv.beltrami_unwrap"]


def test_while_it_runs_the_panel_shows_how_far_it_is(scene, installed):
    installed.running.shown["job"] = SimpleNamespace(fraction=0.5, stage="flatten")
    try:
        assert drawn(installed.panels.IMAGE_PT_beltrami) == [(0.5, "flatten (Esc: cancel)")]
    finally:
        installed.running.shown["job"] = None


class Manager:
    """A window manager that counts what was begun and ended."""

    windows = ()

    def __init__(self):
        self.timers = self.bars = self.handlers = 0

    def progress_begin(self, least, most):
        self.bars += 1

    def progress_update(self, value):
        assert 0 <= value <= 100

    def progress_end(self):
        self.bars -= 1

    def event_timer_add(self, seconds, window):
        assert seconds <= 0.1
        self.timers += 1
        return "timer"

    def event_timer_remove(self, timer):
        assert timer == "timer"
        self.timers -= 1

    def modal_handler_add(self, operator):
        self.handlers += 1


@pytest.fixture
def window(scene, installed, monkeypatch):
    """Return what an operator sees in a window: a context, and what it reports."""
    import bpy as real

    seen = SimpleNamespace(app=SimpleNamespace(background=False), types=real.types)
    monkeypatch.setattr(installed.running, "bpy", seen)
    texts = []
    workspace = SimpleNamespace(status_text_set=texts.append)
    context = SimpleNamespace(window_manager=Manager(), window=None, workspace=workspace)
    return SimpleNamespace(context=context, texts=texts)


def operator_of(installed, work):
    class Operator(installed.running.RunningMixin):
        bl_label = "Test"

        def __init__(self):
            self.written, self.reports = [], []

        def prepare(self, context):
            return work

        def finish(self, context, result):
            self.written.append(result)

        def report(self, level, text):
            self.reports.append((level, text))

    return Operator()


def event(kind, value="NOTHING"):
    return SimpleNamespace(type=kind, value=value)


def test_esc_ends_at_once_whatever_the_thread_does(window, installed):
    go_on, ended = threading.Event(), []

    def work(progress):
        progress(0.3, "flatten")
        go_on.wait(PATIENCE)  # a long step without a look at the request
        ended.append(progress(0.4, "flatten"))
        return "UVs"

    operator = operator_of(installed, work)
    context = window.context
    assert operator.invoke(context, event("LEFTMOUSE")) == {"RUNNING_MODAL"}
    assert operator.modal(context, event("TIMER")) == {"RUNNING_MODAL"}
    assert operator.modal(context, event("MOUSEMOVE")) == {"RUNNING_MODAL"}
    assert "Test: 30%, flatten" in window.texts[-1]
    assert installed.running.shown["job"] is not None
    assert operator.modal(context, event("ESC", "PRESS")) == {"CANCELLED"}
    assert not go_on.is_set()
    assert operator.written == []
    assert context.window_manager.timers == context.window_manager.bars == 0
    assert window.texts[-1] is None
    assert installed.running.shown["job"] is None
    go_on.set()
    assert operator._job.wait(PATIENCE)
    assert ended == [False]  # it is asked to end, and then writes nothing
    assert operator.written == []


def test_what_ends_is_written_in_the_windows_own_thread(window, installed):
    go_on = threading.Event()

    def work(progress):
        go_on.wait(PATIENCE)
        return threading.current_thread()

    operator = operator_of(installed, work)
    operator.finish = lambda context, thread: operator.written.append(
        (thread, threading.current_thread())
    )
    context = window.context
    assert operator.invoke(context, event("LEFTMOUSE")) == {"RUNNING_MODAL"}
    go_on.set()
    assert operator._job.wait(PATIENCE)
    assert operator.modal(context, event("TIMER")) == {"FINISHED"}
    ((of_work, of_writing),) = operator.written
    assert of_work is not of_writing
    assert of_writing is threading.current_thread()
    assert context.window_manager.timers == context.window_manager.bars == 0


def test_what_is_short_is_over_before_progress_is_shown(window, installed):
    operator = operator_of(installed, lambda progress: "UVs")
    assert operator.invoke(window.context, event("LEFTMOUSE")) == {"FINISHED"}
    assert operator.written == ["UVs"]
    assert window.context.window_manager.handlers == 0


def test_failures_are_sentences(window, installed):
    def work(progress):
        raise ValueError("charts have no room: raise the resolution")

    operator = operator_of(installed, work)
    assert operator.invoke(window.context, event("LEFTMOUSE")) == {"CANCELLED"}
    assert operator.execute(window.context) == {"CANCELLED"}
    assert operator.reports == 2 * [({"ERROR"}, "Charts have no room: raise the resolution")]
    assert operator.written == []


def test_a_window_that_closes_ends_the_run(window, installed):
    go_on = threading.Event()
    operator = operator_of(installed, lambda progress: go_on.wait(PATIENCE))
    operator.invoke(window.context, event("LEFTMOUSE"))
    operator.cancel(window.context)
    go_on.set()
    assert installed.running.shown["job"] is None
    assert window.context.window_manager.timers == 0
