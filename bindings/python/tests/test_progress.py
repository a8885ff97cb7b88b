"""Progress, cancelling, Ctrl-C, threads."""

from __future__ import annotations

import contextlib
import hashlib
import os
import signal
import socket
import subprocess
import sys
import textwrap
import threading
import time

import pytest
from conftest import BUST, ROOT

import beltrami
from beltrami import _interrupt, _progress

# Minutes of work, for runs that are to be ended.
ENDLESS = {"method": "cm", "tolerance": 0.0, "max_iterations": 1000000}


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
    import sys, time
    sys.path.insert(0, {tests!r})
    import beltrami
    from conftest import read_obj
    vertices, _, faces = read_obj(__import__("pathlib").Path({bust!r}))
    print("ready", flush=True)
    try:
        beltrami.parameterize(vertices, faces, **{options!r})
    except KeyboardInterrupt:
        print("interrupted", flush=True)
        again = beltrami.parameterize(vertices, faces, method="tutte")
        print(again.injective, flush=True)
"""


@pytest.mark.parametrize("delay", [0.05, 0.3, 0.8])
def test_ctrl_c_raises_keyboard_interrupt_promptly(delay):
    program = textwrap.dedent(INTERRUPTED).format(
        tests=str(ROOT / "bindings/python/tests"), bust=str(BUST), options=ENDLESS
    )
    process = subprocess.Popen(
        [sys.executable, "-B", "-c", program], stdout=subprocess.PIPE, text=True
    )
    with process:
        assert process.stdout.readline() == "ready\n"
        time.sleep(delay)
        start = time.monotonic()
        process.send_signal(signal.SIGINT)
        assert process.stdout.readline() == "interrupted\n"
        assert time.monotonic() - start < 2
        assert process.stdout.readline() == "True\n"
    assert process.returncode == 0


def interrupt_soon():
    """Have this process get the signal of Ctrl-C in 50 ms."""
    threading.Timer(0.05, os.kill, (os.getpid(), signal.SIGINT)).start()


def compute():
    """Compute in C for some tenths of a second, deaf to signals."""
    hashlib.pbkdf2_hmac("sha256", b"", b"", 2_000_000)


def test_ctrl_c_is_heard_while_python_does_not_run():
    heard = []
    with _interrupt.watched(lambda: heard.append(time.monotonic())) as interrupt:
        interrupt_soon()
        compute()
        ended = time.monotonic()
    assert interrupt.came
    assert len(heard) == 1
    assert ended - heard[0] > 0.1
    assert signal.set_wakeup_fd(-1) == -1
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_ctrl_c_interrupts_a_callback_that_waits(hump):
    def wait(_fraction, _stage):
        interrupt_soon()
        time.sleep(30)

    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        beltrami.parameterize(*hump, progress=wait)
    assert time.monotonic() - start < 5


def test_ctrl_c_at_any_time_leaves_a_flattener_that_works(hump):
    flattener = beltrami.Flattener()
    expected = flattener.parameterize(*hump).uv.tobytes()
    for _ in range(30):
        with contextlib.suppress(KeyboardInterrupt):
            interrupt_soon()
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


def test_a_run_is_cancelled_from_another_thread(bust):
    flattener = beltrami.Flattener(**ENDLESS)
    flattener.set_mesh(*bust)
    started, asked = threading.Event(), []

    def cancel():
        started.wait()
        asked.append(time.monotonic())
        flattener.cancel()

    thread = threading.Thread(target=cancel)
    thread.start()
    with pytest.raises(beltrami.Cancelled):
        flattener.run(progress=lambda *_: started.set())
    thread.join()
    assert time.monotonic() - asked[0] < 2


def test_a_request_before_a_run_is_for_that_run_only(hump):
    flattener = beltrami.Flattener()
    flattener.set_mesh(*hump)
    flattener.cancel()
    with pytest.raises(beltrami.Cancelled):
        flattener.run()
    assert flattener.run().injective
    flattener.cancel()
    assert flattener.parameterize(*hump).injective  # the new mesh drops it


def test_the_gil_is_released_while_the_library_works(bust):
    counted = 0
    done = threading.Event()

    def count():
        nonlocal counted
        while not done.is_set():
            counted += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    started = time.monotonic()
    beltrami.parameterize(*bust)
    seconds = time.monotonic() - started
    done.set()
    thread.join()
    assert counted > 0.2 * seconds / 0.001


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


def test_a_second_thread_is_refused_while_a_flattener_runs(bust):
    flattener = beltrami.Flattener(**ENDLESS)
    flattener.set_mesh(*bust)
    started, refusals = threading.Event(), []

    def meddle():
        started.wait()
        for call in (flattener.run, lambda: flattener.set_options(threads=2)):
            with pytest.raises(beltrami.InvalidStateError) as caught:
                call()
            refusals.append(caught.value.status)
        flattener.cancel()

    thread = threading.Thread(target=meddle)
    thread.start()
    with pytest.raises(beltrami.Cancelled):
        flattener.run(progress=lambda *_: started.set())
    thread.join()
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
