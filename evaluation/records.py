"""Figures of benchmarks as records that stay, as those of the programs of benchmarks/ do."""

from __future__ import annotations

import argparse
import datetime
import json
import platform
import subprocess
from collections.abc import Iterable, Mapping
from pathlib import Path

import beltrami

ROOT = Path(__file__).resolve().parents[1]


def add_option(parser: argparse.ArgumentParser) -> None:
    """Add --record."""
    parser.add_argument(
        "--record",
        action="store_true",
        help="append the figures to benchmarks/history, with commit and machine",
    )


def processor() -> str:
    """Return the name of the processor."""
    cpu = Path("/proc/cpuinfo")
    lines = cpu.read_text().splitlines() if cpu.exists() else []
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor()


def write(benchmark: str, rows: Iterable[Mapping[str, object]]) -> None:
    """Append rows to the history of a benchmark, a line of JSON each."""
    described = subprocess.run(
        ["git", "-C", str(ROOT), "describe", "--always", "--dirty"],
        capture_output=True,
        text=True,
        check=False,
    )
    head = {
        "date": datetime.datetime.now(datetime.timezone.utc).date().isoformat(),
        "commit": described.stdout.strip(),
        "processor": processor(),
        "build": beltrami.build_info(),
    }
    path = ROOT / "benchmarks" / "history" / f"{benchmark}.jsonl"
    path.parent.mkdir(exist_ok=True)
    with path.open("a") as file:
        for row in rows:
            file.write(json.dumps({**head, **row}) + "\n")
