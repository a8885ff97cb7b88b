# SPDX-FileCopyrightText: 2026 The beltrami authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators that compute in a thread, with progress, and end on Esc.

A run reads meshes, computes on arrays in a thread that never touches Blender, and writes at the
end. So Esc leaves everything as it was, at once: what the thread still does is dropped.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import bpy

import beltrami

from .uv_logic.jobs import Job, Progress, end_all, silent

_INTERVAL = 0.05  # seconds between two looks at the thread
_SHORT = 0.15  # seconds in which a run ends without progress being shown
_LAST = 10.0  # seconds that a thread has for its end, when Blender quits
#: What is refused or fails with a sentence for users.
_FAILURES = (beltrami.BeltramiError, ValueError, MemoryError)

#: What panels show: the job under way, what the last check said, and what live unwrapping says.
shown: dict[str, Any] = {"job": None, "check": (), "live": ""}


class RunningMixin:
    """What `Unwrap`, `Pack` and the others have in common.

    They have two functions: ``prepare(context)`` reads meshes and returns the work, a function of
    the progress; ``finish(context, result)`` writes what the work returned.
    """

    _job: Job | None = None
    _timer: Any = None

    prepare: Callable[[Any], Callable[[Progress], Any]]
    finish: Callable[[Any, Any], None]

    @classmethod
    def poll(cls, context: Any) -> bool:
        """Return whether there is a mesh to work on."""
        if context.mode == "EDIT_MESH":
            return True
        if context.mode == "OBJECT" and any(o.type == "MESH" for o in context.selected_objects):
            return True
        cls.poll_message_set("Select mesh objects, or edit them")
        return False

    def execute(self, context: Any) -> set[str]:
        """Run to the end, as scripts and the panel of the last operation want it."""
        try:
            result = self.prepare(context)(silent)
        except _FAILURES as error:
            return self._refused(error)
        return self._finished(context, result)

    def invoke(self, context: Any, event: Any) -> set[str]:
        """Run in a thread, while the window stays alive."""
        if bpy.app.background or shown["job"] is not None:
            return self.execute(context)
        try:
            self._job = Job(self.prepare(context)).start()
        except _FAILURES as error:
            return self._refused(error)
        if self._job.wait(_SHORT):
            return self._end(context)
        shown["job"] = self._job
        manager = context.window_manager
        manager.progress_begin(0, 100)
        self._timer = manager.event_timer_add(_INTERVAL, window=context.window)
        manager.modal_handler_add(self)
        self._show(context)
        return {"RUNNING_MODAL"}

    def modal(self, context: Any, event: Any) -> set[str]:
        """Show how far the run is, and end with it or on Esc."""
        assert self._job is not None
        if event.type == "ESC" and event.value == "PRESS":
            self._job.cancel()
            self._hide(context)
            self.report({"INFO"}, "Cancelled: nothing has changed")
            return {"CANCELLED"}
        if event.type == "TIMER":
            if self._job.done:
                self._hide(context)
                return self._end(context)
            self._show(context)
        return {"RUNNING_MODAL"}

    def cancel(self, context: Any) -> None:
        """End with the window, or with the file."""
        if self._job is not None:
            self._job.cancel()
            self._hide(context)

    def _end(self, context: Any) -> set[str]:
        assert self._job is not None
        try:
            result = self._job.result()
        except _FAILURES as error:
            return self._refused(error)
        return self._finished(context, result)

    def _finished(self, context: Any, result: Any) -> set[str]:
        try:
            self.finish(context, result)
        except _FAILURES as error:
            return self._refused(error)
        return {"FINISHED"}

    def _refused(self, error: BaseException) -> set[str]:
        sentence = str(error) or type(error).__name__
        if isinstance(error, beltrami.PinError):
            sentence = "no map without flips meets all pins: unpin some, or move them"
        self.report({"ERROR"}, sentence[:1].upper() + sentence[1:])
        return {"CANCELLED"}

    def _show(self, context: Any) -> None:
        assert self._job is not None
        percent = int(100 * self._job.fraction)
        context.window_manager.progress_update(percent)
        text = f"{self.bl_label}: {percent}%, {self._job.stage}    Esc: cancel"
        context.workspace.status_text_set(text)
        redraw(context)

    def _hide(self, context: Any) -> None:
        shown["job"] = None
        manager = context.window_manager
        manager.event_timer_remove(self._timer)
        manager.progress_end()
        context.workspace.status_text_set(None)
        redraw(context)


def unregister() -> None:
    """End what still computes: Blender quits, or the extension is disabled."""
    end_all(_LAST)


def redraw(context: Any) -> None:
    """Have the editors of pictures drawn anew, with their panels."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "IMAGE_EDITOR":
                area.tagredraw()
