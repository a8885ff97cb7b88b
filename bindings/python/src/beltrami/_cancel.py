"""A handle that ends calls of the package, from any thread."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Iterator
from typing import Callable

from ._errors import Cancelled

_STATUS = (-6, "BELTRAMI_E_CANCELLED")


class CancelToken:
    """Ends calls from any thread: give it to them as `cancel`, and call its `cancel` to end them.

    A call that is ended raises `Cancelled`. A token stays cancelled, so no request is lost, whether
    it comes before, during or between calls; take a new one for new work. Several calls may have
    the same token, at the same time, too. Signal handlers may cancel it.

    Examples
    --------
    A thread of its own works, and this one ends it:

    >>> import threading
    >>> corners, faces = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 1, 2], [0, 3, 1]]
    >>> token = beltrami.CancelToken()
    >>> outcome = []
    >>> def work():
    ...     try:
    ...         outcome.append(beltrami.unwrap(corners, faces, cancel=token))
    ...     except beltrami.Cancelled as cancelled:
    ...         outcome.append(cancelled.status)
    >>> thread = threading.Thread(target=work)
    >>> token.cancel()
    >>> thread.start()
    >>> thread.join()
    >>> outcome
    ['BELTRAMI_E_CANCELLED']
    """

    def __init__(self) -> None:
        self._lock = threading.RLock()  # a signal handler comes in the thread that holds it
        self._cancelled = False
        self._ends: list[Callable[[], None]] = []  # of the calls under way

    @property
    def cancelled(self) -> bool:
        """Whether `cancel` has been called."""
        return self._cancelled

    def cancel(self) -> None:
        """End the calls that have this token, those under way and those to come; returns at once.

        One under way is heard within some milliseconds of its work, but inside an ordering or a
        factorization of a large matrix.
        """
        with self._lock:
            self._cancelled = True
            for end in tuple(self._ends):
                end()

    def check(self) -> None:
        """Raise `Cancelled` if `cancel` has been called: for loops of your own."""
        if self._cancelled:
            raise Cancelled("the call was cancelled by its token", *_STATUS)


def check(token: CancelToken | None) -> None:
    """Raise Cancelled where there is a token that is cancelled; TypeError where it is none."""
    if token is None:
        return
    if not isinstance(token, CancelToken):
        raise TypeError(f"cancel is {token!r}: give a beltrami.CancelToken")
    token.check()


@contextlib.contextmanager
def ending(token: CancelToken | None, end: Callable[[], None]) -> Iterator[None]:
    """Have `token` call `end`, from any thread, at once where it is cancelled already."""
    if token is None:
        yield
        return
    with token._lock:
        token._ends.append(end)
        if token._cancelled:
            end()
    try:
        yield
    finally:
        with token._lock:  # afterwards nobody calls it any more
            token._ends.remove(end)
