"""What the argument `progress` may be, as the hook that a run calls."""

from __future__ import annotations

import contextlib
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Callable, Optional, Union

from ._library import Hook

#: None or False: nothing. True: a bar. A function of the fraction in [0, 1], which never decreases,
#: and of the name of the stage: it cancels by returning False, and by raising.
Progress = Union[None, bool, Callable[[float, str], Optional[bool]]]

_BAR_WIDTH = 30  # the whole line fits a terminal of 60 columns
_REDRAW_SECONDS = 0.1


def _silent(_fraction: float, _stage: str) -> bool:
    return False


def _short(stage: str) -> str:
    """Return what a bar has room for: of a path, which is what a batch tells, the name."""
    return Path(stage).name


class _TextBar:
    """One line on stderr, where that is a terminal."""

    def __init__(self) -> None:
        self._start = time.monotonic()
        self._last = (-1.0, "")

    def __call__(self, fraction: float, stage: str) -> bool:
        now = time.monotonic()
        if now - self._last[0] < _REDRAW_SECONDS and stage == self._last[1]:
            return False
        self._last = (now, stage)
        bar = ("#" * int(fraction * _BAR_WIDTH)).ljust(_BAR_WIDTH, ".")
        seconds = now - self._start
        line = f"{_short(stage):<10.10} [{bar}] {int(fraction * 100):3}% {seconds:7.1f} s"
        sys.stderr.write(f"\r\x1b[2K{line}")
        sys.stderr.flush()
        return False

    def close(self) -> None:
        sys.stderr.write("\r\x1b[2K")
        sys.stderr.flush()


class _TqdmBar:
    """A bar of tqdm, which draws itself in notebooks, too."""

    def __init__(self, tqdm: Any) -> None:
        self._bar = tqdm(
            total=1.0, leave=False, bar_format="{desc} {percentage:3.0f}%|{bar}| {elapsed}"
        )

    def __call__(self, fraction: float, stage: str) -> bool:
        self._bar.set_description_str(_short(stage), refresh=False)
        self._bar.update(fraction - self._bar.n)
        return False

    def close(self) -> None:
        self._bar.close()


def _bar() -> _TqdmBar | _TextBar | None:
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return _TextBar() if sys.stderr is not None and sys.stderr.isatty() else None
    return _TqdmBar(tqdm)


@contextlib.contextmanager
def hook_for(progress: Progress) -> Iterator[Hook]:
    """Yield the hook for `progress`, and close what it draws."""
    if callable(progress):
        yield lambda fraction, stage: progress(fraction, stage) is False
        return
    if not (progress is None or isinstance(progress, bool)):
        raise TypeError(f"progress is {progress!r}: give True, False or a function")
    bar = _bar() if progress else None
    if bar is None:
        yield _silent
        return
    try:
        yield bar
    finally:
        bar.close()
