"""Ctrl-C while the library works.

Python runs its signal handlers between its own instructions: not before the library reports
progress, which at a million faces can take seconds. What Python does at once is to write to its
wakeup file descriptor, so a thread waits there and asks the library to end.
"""

from __future__ import annotations

import contextlib
import signal
import socket
import threading
from collections.abc import Iterator
from typing import Any, Callable


class Interrupt:
    """Stands in for Python's handler of Ctrl-C, which could raise where things are half done."""

    def __init__(self) -> None:
        self.came = False
        self.in_callback = False  # the user's code, which is interrupted as ever

    def __call__(self, number: int, frame: Any) -> None:
        """Handle the signal."""
        self.came = True
        if self.in_callback:
            signal.default_int_handler(number, frame)


@contextlib.contextmanager
def watched(cancel: Callable[[], None]) -> Iterator[Interrupt]:
    """Call `cancel` at once on Ctrl-C, from another thread; the caller raises if it `came`.

    Does nothing where Ctrl-C does not raise KeyboardInterrupt: in other threads than the main one,
    and under a handler of the host's.
    """
    interrupt = Interrupt()
    is_main = threading.current_thread() is threading.main_thread()
    if not is_main or signal.getsignal(signal.SIGINT) is not signal.default_int_handler:
        yield interrupt
        return
    signal.signal(signal.SIGINT, interrupt)
    try:
        with _listening(cancel):
            yield interrupt
    finally:
        signal.signal(signal.SIGINT, signal.default_int_handler)


@contextlib.contextmanager
def _listening(cancel: Callable[[], None]) -> Iterator[None]:
    receiver, sender = socket.socketpair()
    with receiver, sender:
        sender.setblocking(False)
        listener = threading.Thread(target=_listen, args=(receiver, cancel), daemon=True)
        listener.start()
        before = signal.set_wakeup_fd(sender.fileno(), warn_on_full_buffer=False)
        if before != -1:  # of an event loop, which needs it
            signal.set_wakeup_fd(before)
        try:
            yield
        finally:
            if before == -1:
                signal.set_wakeup_fd(-1)
            sender.shutdown(socket.SHUT_WR)  # the end of what the listener hears
            listener.join()


def _listen(receiver: socket.socket, cancel: Callable[[], None]) -> None:
    while numbers := receiver.recv(64):
        if signal.SIGINT in numbers:
            cancel()
