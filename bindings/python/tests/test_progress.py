"""Progress, cancelling, Ctrl-C, threads."""

from __future__ import annotations

import contextlib
import os
import signal
import socket
import subprocess
import sys
import textwrap
import threading
import time

import pytest
from conftest import ROOT

import beltrami
from beltrami import _interrupt, _progress

# Seconds after which what waits has failed: no machine takes as long for what it waits for.
HANG = 600


# ---- Callbacks ----------------------------------------------------------------------------


def test_progress_is_told_in_this_thread_and_never_decreases(bust):
    seen = []
    beltrami.parameterize(*bust, progress=lambda *args: seen.append((threading.get_ident(), *args)))
    fractions = [fraction for _, fraction, _ in seen]
    assert fractions == sorted(fractions)
    assert 0 <= fractions[0] <= fractions[-1] <= 1
    assert {"coarse", "flatten", "certify"} <= {stage for _, _, stage in seen}
    assert {thread for thread, _, _ in seen} == {threading.get_ident()}


def test_only_false_cancels(hump):
    for answer in (None, True, 0, "", []):
        assert beltrami.parameterize(*hump, progress=lambda *_, a=answer: a).injective
    with pytest.raises(beltrami.Cancelled) as caught:
        beltrami.parameterize(*hump, progress=lambda *_: False)
    assert caught.value.status == "BELTRAMI_E_CANCELLED"


def test_other_things_than_functions_are_refused(hump):
    with pytest.raises(TypeError, match="progress is 'yes': give True, False or a function"):
        beltrami.parameterize(*hump, progress="yes")


@pytest.mark.parametrize("error", [ZeroDivisionError, KeyboardInterrupt, SystemExit])
def test_what_progress_raises_is_passed_on(hump, error):
    def raise_in_coarse(_fraction, stage):
        if stage == "coarse":
            raise error("in coarse")

    with pytest.raises(error, match="in coarse"):
        beltrami.parameterize(*hump, progress=raise_in_coarse)


def test_a_flattener_goes_on_after_a_run_was_cancelled(hump):
    flattener = beltrami.Flattener()
    first = flattener.parameterize(*hump)
    with pytest.raises(beltrami.Cancelled):
        flattener.run(progress=lambda *_: False)
    assert flattener.run().uv.tobytes() == first.uv.tobytes()


def test_progress_may_flatten_another_mesh(hump):
    inner = []

    def flatten(_fraction, _stage):
        if not inner:
            inner.append(beltrami.parameterize(*hump, progress=lambda *_: None).uv)

    outer = beltrami.parameterize(*hump, progress=flatten)
    assert inner[0].tobytes() == outer.uv.tobytes()


def test_progress_may_not_use_its_own_flattener(hump):
    flattener = beltrami.Flattener()
    with pytest.raises(beltrami.InvalidStateError, match="in use"):
        flattener.parameterize(*hump, progress=lambda *_: flattener.run())


# ---- Bars ---------------------------------------------------------------------------------


class Screen:
    """A stream that may be a terminal."""

    def __init__(self, terminal):
        self.terminal = terminal
        self.text = ""

    def isatty(self):
        return self.terminal

    def write(self, text):
        self.text += text

    def flush(self):
        pass


def test_a_terminal_shows_one_line_that_goes_away(hump, monkeypatch):
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    screen = Screen(terminal=True)
    monkeypatch.setattr(sys, "stderr", screen)
    beltrami.parameterize(*hump, progress=True)
    assert "coarse     [" in screen.text
    assert screen.text.endswith("\r\x1b[2K")
    assert "\n" not in screen.text


def test_a_bar_shows_the_name_of_a_path():
    assert _progress._short("/scans/bust.ply") == "bust.ply"
    assert _progress._short("coarse") == "coarse"


def test_elsewhere_nothing_is_printed(hump, monkeypatch, capfd):
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    beltrami.parameterize(*hump, progress=True)
    monkeypatch.setattr(sys, "stderr", None)  # as under pythonw
    beltrami.parameterize(*hump, progress=True)
    assert capfd.readouterr() == ("", "")


def test_tqdm_draws_where_it_is_installed(hump, capsys):
    pytest.importorskip("tqdm")
    beltrami.parameterize(*hump, progress=True)
    assert "%|" in capsys.readouterr().err


def test_the_bar_is_closed_when_a_run_fails(monkeypatch):
    closed = []
    bar = _progress._TextBar()
    monkeypatch.setattr(bar, "close", lambda: closed.append(True))
    monkeypatch.setattr(_progress, "_bar", lambda: bar)
    with pytest.raises(beltrami.InvalidStateError):
        beltrami.Flattener().run(progress=True)
    assert closed == [True]


# ---- Ctrl-C -------------------------------------------------------------------------------

INTERRUPTED = """
    import sys
    sys.path.insert(0, {tests!r})
    import beltrami
    from conftest import grid
    mesh = grid(60)
    try:
        while True:
            beltrami.parameterize(*mesh)
            print("ran\\n", end="", flush=True)  # whole, or not at all
    except KeyboardInterrupt:
        again = beltrami.parameterize(*mesh)
        print("interrupted", again.injective, flush=True)
"""


def test_ctrl_c_raises_keyboard_interrupt():
    program = textwrap.dedent(INTERRUPTED).format(tests=str(ROOT / "bindings/python/tests"))
    command = [sys.executable, "-B", "-c", program]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline() == "ran\n"
        process.send_signal(signal.SIGINT)
        rest = [line for line in process.stdout.read().splitlines() if line != "ran"]
    assert (rest, process.returncode) == (["interrupted True"], 0)


def send_ctrl_c():
    """Have this process get the signal of Ctrl-C."""
    os.kill(os.getpid(), signal.SIGINT)


def test_ctrl_c_is_heard_while_python_does_not_run():
    ours, theirs = socket.socketpair()
    with ours, theirs:
        ours.settimeout(HANG)
        with _interrupt.watched(lambda: theirs.send(b"heard")) as interrupt:
            signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])  # not this thread
            try:
                send_ctrl_c()
                heard = ours.recv(5)
            finally:
                signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGINT])
    assert heard == b"heard"
    assert interrupt.came
    assert signal.set_wakeup_fd(-1) == -1
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


@pytest.mark.parametrize("stage", ["simplify", "coarse", "flatten", "polish", "certify"])
def test_a_run_hears_of_ctrl_c_before_it_tells_of_more_progress(bust, monkeypatch, stage):
    flattener = beltrami.Flattener()
    flattener.set_mesh(*bust)
    reached, reports, reports_at_cancel = threading.Event(), [], []
    cancel = flattener._context.cancel

    def cancel_and_count():
        cancel()
        reports_at_cancel.append(len(reports))

    monkeypatch.setattr(flattener._context, "cancel", cancel_and_count)

    def report(_fraction, name):
        reports.append(name)
        if name == stage:
            reached.set()

    def interrupt():
        assert reached.wait(HANG)
        send_ctrl_c()

    thread = threading.Thread(target=interrupt)
    thread.start()
    with pytest.raises(KeyboardInterrupt):
        while True:  # the signal may come between two runs
            flattener.run(progress=report)
    thread.join()
    assert stage in reports
    # One report may be on its way.
    assert all(len(reports) - count <= 1 for count in reports_at_cancel)
    assert flattener.run().injective


def test_ctrl_c_interrupts_a_callback_that_waits(hump):
    waits = []

    def wait(_fraction, _stage):
        waits.append("begun")
        threading.Timer(0, send_ctrl_c).start()
        threading.Event().wait(HANG)
        waits.append("ended")

    with pytest.raises(KeyboardInterrupt):
        beltrami.parameterize(*hump, progress=wait)
    assert waits == ["begun"]


def test_ctrl_c_at_any_time_leaves_a_flattener_that_works(hump):
    flattener = beltrami.Flattener()
    expected = flattener.parameterize(*hump).uv.tobytes()
    for _ in range(30):
        with contextlib.suppress(KeyboardInterrupt):
            threading.Timer(0.05, send_ctrl_c).start()
            while True:
                flattener.run()
        assert flattener.run().uv.tobytes() == expected


def test_a_handler_of_the_host_is_left_alone(hump):
    numbers = []
    before = signal.signal(signal.SIGINT, lambda number, _frame: numbers.append(number))
    try:
        result = beltrami.parameterize(
            *hump, progress=lambda *_: None if numbers else signal.raise_signal(signal.SIGINT)
        )
    finally:
        signal.signal(signal.SIGINT, before)
    assert result.injective
    assert numbers == [signal.SIGINT]


def test_an_event_loop_that_listens_to_signals_goes_on_listening(hump):
    ours, theirs = socket.socketpair()
    with ours, theirs:
        theirs.setblocking(False)
        signal.set_wakeup_fd(theirs.fileno())
        try:
            with pytest.raises(KeyboardInterrupt):
                beltrami.parameterize(*hump, progress=lambda *_: signal.raise_signal(signal.SIGINT))
            assert signal.set_wakeup_fd(-1) == theirs.fileno()
        finally:
            signal.set_wakeup_fd(-1)
        assert ours.recv(1) == bytes([signal.SIGINT])


# ---- Threads ------------------------------------------------------------------------------


class Meeting:
    """Another thread that does something while a run waits for it in its first report."""

    def __init__(self, act):
        self._begun, self._over = threading.Event(), threading.Event()
        self._act = act
        self._thread = threading.Thread(target=self._meet)

    def _meet(self):
        if self._begun.wait(HANG):
            try:
                self._act()
            finally:
                self._over.set()

    def __call__(self, _fraction, _stage):
        """Be the progress of the run."""
        self._begun.set()
        assert self._over.wait(HANG)

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._thread.join()


def test_a_run_is_cancelled_from_another_thread(hump):
    flattener = beltrami.Flattener()
    flattener.set_mesh(*hump)
    with Meeting(flattener.cancel) as meeting, pytest.raises(beltrami.Cancelled):
        flattener.run(progress=meeting)


def test_a_request_before_a_run_is_for_that_run_only(hump):
    flattener = beltrami.Flattener()
    flattener.set_mesh(*hump)
    flattener.cancel()
    with pytest.raises(beltrami.Cancelled):
        flattener.run()
    assert flattener.run().injective
    flattener.cancel()
    assert flattener.parameterize(*hump).injective  # the new mesh drops it


@pytest.fixture
def counter():
    """Let a thread count; this one does not give way but where it lets go of the GIL."""
    counted, done = [0], threading.Event()

    def count():
        while not done.is_set():
            counted[0] += 1
            time.sleep(0)

    thread = threading.Thread(target=count)
    before = sys.getswitchinterval()
    thread.start()
    sys.setswitchinterval(HANG)
    yield counted
    sys.setswitchinterval(before)
    done.set()
    thread.join()


def test_the_gil_is_released_while_the_library_works(hump, counter):
    def work():
        yield counter[0]
        beltrami.check_injective(hump[0][:, :2], hump[1])
        yield counter[0]

    # Whether the system has the other thread run in one call is not certain, in many it is.
    assert any(len(set(work())) == 2 for _ in range(10000))


def test_the_gil_is_released_between_reports(bust, counter):
    def counts():
        seen = []
        beltrami.parameterize(*bust, progress=lambda *_: seen.append(counter[0]))
        return set(seen)

    assert any(len(counts()) > 1 for _ in range(100))


def test_flatteners_work_side_by_side(hump):
    expected = beltrami.parameterize(*hump).uv.tobytes()
    found = []

    def work():
        found.extend(beltrami.parameterize(*hump).uv.tobytes() for _ in range(20))

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == 80 * [expected]


def test_a_second_thread_is_refused_while_a_flattener_runs(hump):
    flattener = beltrami.Flattener()
    flattener.set_mesh(*hump)
    refusals = []

    def meddle():
        for call in (flattener.run, lambda: flattener.set_options(threads=2)):
            with pytest.raises(beltrami.InvalidStateError) as caught:
                call()
            refusals.append(caught.value.status)

    with Meeting(meddle) as meeting:
        assert flattener.run(progress=meeting).injective
    assert refusals == 2 * ["BELTRAMI_E_INVALID_STATE"]


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork on this system")
@pytest.mark.filterwarnings("ignore:.*multi-threaded:DeprecationWarning")
def test_a_forked_process_works_on(hump):
    flattener = beltrami.Flattener(threads=2)
    expected = flattener.parameterize(*hump).uv.tobytes()
    child = os.fork()
    if child == 0:
        with contextlib.suppress(BaseException):
            os._exit(0 if flattener.run().uv.tobytes() == expected else 1)
        os._exit(2)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
