# SPDX-FileCopyrightText: 2026 The beltrami authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Work in a thread of its own, with progress and cancelling."""

from __future__ import annotations

import threading
import weakref
from collections.abc import Callable
from typing import Any

#: Told a fraction in [0, 1] and the name of a stage; False asks the work to end.
Progress = Callable[[float, str], bool]


def silent(_fraction: float, _stage: str) -> bool:
    """Tell nobody."""
    return True


def part_of(progress: Progress, before: float, share: float) -> Progress:
    """Return the progress of a part of some work, which is told fractions of the part."""
    return lambda fraction, stage: progress(min(1.0, before + share * fraction), stage)


_started: weakref.WeakSet[Job] = weakref.WeakSet()


def end_all(seconds: float) -> bool:
    """Ask all work to end, and wait so long for each; return whether all has ended.

    A thread that came back into Python while that shuts down would take Blender with it.
    """
    jobs = list(_started)
    for job in jobs:
        job.cancel()
    ended = [job.wait(seconds) for job in jobs]
    return all(ended)


class Job:
    """Work in a thread of its own. The work must not touch Blender's data.

    `cancel` returns at once, and what the work then returns or raises is dropped: whoever started
    it need not wait for the moment at which it notices.
    """

    def __init__(self, work: Callable[[Progress], Any]) -> None:
        self._work = work
        self._cancelled = threading.Event()
        self._result: Any = None
        self._error: BaseException | None = None
        self.fraction = 0.0
        self.stage = ""
        self._thread = threading.Thread(target=self._run, name="beltrami", daemon=True)

    def start(self) -> Job:
        """Begin."""
        _started.add(self)
        self._thread.start()
        return self

    def cancel(self) -> None:
        """Ask the work to end."""
        self._cancelled.set()

    @property
    def done(self) -> bool:
        """Whether the work has ended."""
        return not self._thread.is_alive()

    def wait(self, seconds: float) -> bool:
        """Wait for the end, so many seconds at most; return whether it has come."""
        self._thread.join(seconds)
        return self.done

    def result(self) -> Any:
        """Return what the work returned, or raise what it raised."""
        self._thread.join()
        if self._error is not None:
            raise self._error
        return self._result

    def _run(self) -> None:
        try:
            self._result = self._work(self._told)
        except BaseException as error:  # whoever asks for the result gets it
            self._error = error

    def _told(self, fraction: float, stage: str) -> bool:
        self.fraction, self.stage = max(self.fraction, fraction), stage
        return not self._cancelled.is_set()
