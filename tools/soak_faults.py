"""Disturb whole runs of the program, and look at what they leave.

    soak_faults.py PROGRAM --seconds N [--seed N]

Each round starts the program on a small mesh, and disturbs it: by a signal at a random time, or by
the one that it cannot handle, by a limit of the size of files or of memory, or by a second run that
writes the same file. An output is to be the old file or a whole new one, nothing is to be left
beside it, and the exit code is to be a known one.
Prints a line for each broken promise, and the count of rounds. The exit code is 1 where one broke.
"""

from __future__ import annotations

import argparse
import random
import resource
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

OLD = b"what was there before\n"
CELLS = 12  # of a bent sheet to a side
EXIT_DONE, EXIT_UNUSABLE, EXIT_NO_MEMORY, EXIT_CANCELLED = 0, 2, 4, 130
# An output of another size than these is cut off by a limit.
LONGEST_DELAY = 0.4  # seconds; a run takes less
LONGEST_FILE = 20_000  # bytes; an output is longer
MIB = 2**20
STEP_OF_MEMORY = 2 * MIB  # in which the least is sought that the program starts in
MORE_MEMORY = 24 * MIB  # than that: some runs end by it, and some do not


def sheet() -> str:
    """Return a bent sheet as OBJ."""
    side = CELLS + 1
    lines = [f"v {i} {j} {(i * i + i * j) / CELLS}" for i in range(side) for j in range(side)]
    for i in range(CELLS):
        for j in range(CELLS):
            corner = i * side + j + 1
            lines.append(f"f {corner} {corner + side} {corner + side + 1} {corner + 1}")
    return "\n".join(lines) + "\n"


def limit(what: int, size: int) -> None:
    """Hold a resource down to a size; in the child."""
    resource.setrlimit(what, (size, size))


class Runs:
    """Runs of the program in a folder of their own."""

    def __init__(self, program: Path, folder: Path) -> None:
        self.program, self.folder = program, folder
        self.out = folder / "out.obj"
        (folder / "in.obj").write_text(sheet())
        process = self.start()
        process.communicate()
        self.whole = self.out.read_bytes()
        self.least_memory = self.memory_to_start()

    def memory_to_start(self) -> int:
        """Return a size of memory in which the program can say its version."""
        size, code = 0, 1
        while code:
            size += STEP_OF_MEMORY
            code = subprocess.run(
                [str(self.program), "--version"],
                capture_output=True,
                check=False,
                preexec_fn=partial(limit, resource.RLIMIT_AS, size),
            ).returncode
        return size

    def start(self, prepare: Callable[[], None] | None = None) -> subprocess.Popen[bytes]:
        """Start one run."""
        command = [str(self.program), "unwrap", "in.obj", "out.obj"]
        return subprocess.Popen(
            command,
            cwd=self.folder,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            preexec_fn=prepare,
        )

    def fresh(self) -> None:
        """Put the old file in place."""
        self.out.write_bytes(OLD)

    def faults(self, codes: set[int], known: set[int]) -> list[str]:
        """Say what is wrong after runs that ended with `codes`."""
        wrong = [f"exit code {code}" for code in sorted(codes - known)]
        kept = self.out.read_bytes()
        if kept not in (OLD, self.whole):
            wrong.append(f"an output of {len(kept)} bytes is neither old nor whole")
        if EXIT_DONE in codes and kept != self.whole:
            wrong.append("a run that succeeded has not written")
        names = sorted(p.name for p in self.folder.iterdir())
        if names != ["in.obj", "out.obj"]:
            wrong.append(f"left: {', '.join(names)}")
        return wrong

    def by_signal(self, chance: random.Random) -> list[str]:
        """Send a signal at a random time; before the program handles it, it ends at once."""
        number = chance.choice([signal.SIGINT, signal.SIGTERM])
        process = self.start()
        time.sleep(chance.uniform(0, LONGEST_DELAY))
        process.send_signal(number)
        process.communicate()
        return self.faults({process.returncode}, {EXIT_DONE, EXIT_CANCELLED, -number})

    def by_limit(self, chance: random.Random) -> list[str]:
        """Have the output be too long for the limit."""
        size = chance.randrange(min(LONGEST_FILE, len(self.whole)))
        process = self.start(partial(limit, resource.RLIMIT_FSIZE, size))
        errors = process.communicate()[1]
        wrong = self.faults({process.returncode}, {EXIT_UNUSABLE})
        if errors.count(b"\n") != 1:
            wrong.append(f"{errors.count(b'%c' % 10)} lines on stderr")
        return wrong

    def by_memory(self, chance: random.Random) -> list[str]:
        """Have memory end anywhere."""
        size = self.least_memory + chance.randrange(MORE_MEMORY)
        process = self.start(partial(limit, resource.RLIMIT_AS, size))
        errors = process.communicate()[1]
        wrong = self.faults({process.returncode}, {EXIT_DONE, EXIT_NO_MEMORY})
        if errors.count(b"\n") != (process.returncode != EXIT_DONE):
            wrong.append(f"{errors.count(b'%c' % 10)} lines on stderr")
        return wrong

    def by_kill(self, chance: random.Random) -> list[str]:
        """End a run at once: what it was writing may stay, under a name of its own."""
        process = self.start()
        time.sleep(chance.uniform(0, LONGEST_DELAY))
        process.kill()
        process.communicate()
        for left in self.folder.glob("*.tmp"):
            left.unlink()
        return self.faults({process.returncode}, {EXIT_DONE, -signal.SIGKILL})

    def by_each_other(self, _chance: random.Random) -> list[str]:
        """Have two runs write one file."""
        both = [self.start(), self.start()]
        for process in both:
            process.communicate()
        return self.faults({process.returncode for process in both}, {EXIT_DONE})


def main() -> int:
    """Disturb runs until the time is over."""
    parser = argparse.ArgumentParser()
    parser.add_argument("program", type=Path)
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--seed", type=int, default=0)
    arguments = parser.parse_args()
    chance = random.Random(arguments.seed)
    end = time.monotonic() + arguments.seconds
    rounds, broken = 0, 0
    with tempfile.TemporaryDirectory() as folder:
        runs = Runs(arguments.program.resolve(), Path(folder))
        ways = [runs.by_signal, runs.by_limit, runs.by_memory, runs.by_kill, runs.by_each_other]
        while time.monotonic() < end:
            way = ways[rounds % len(ways)]
            runs.fresh()
            for wrong in way(chance):
                print(f"BROKEN: {way.__name__}, round {rounds}: {wrong}", flush=True)
                broken += 1
            rounds += 1
    print(f"{rounds} rounds")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
