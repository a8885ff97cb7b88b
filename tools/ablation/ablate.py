"""What each special case is worth: the program with it and without it.

    ablate.py [--of flatten|unwrap] --record FILE [--without NAME ...] [--jobs N] MESH ...
    ablate.py [--of flatten|unwrap] --table PAGE --record FILE
    ablate.py --check

A case of cases.json is a text of a source and what stands in its place without the case. A copy of
the sources in build/ablation is compiled for each. It flattens or unwraps the meshes in turns with
the program as it is, on one thread. The record has a line for each case and mesh; a table is made
of it.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import shutil
import statistics
import subprocess
import sys
from collections import defaultdict
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
CASES = Path(__file__).parent / "cases.json"
WORK = ROOT / "build" / "ablation"
TREE = WORK / "tree"
COPIED = ("src", "include", "program", "cmake", "abi", "benchmarks", "CMakeLists.txt")
# A case stays if it is worth one of these: of the CPU and of the cost in the mean, of either on one
# of the hardest two meshes, or a map that is injective (of an atlas: and has its target).
WORTH_CPU, WORTH_HARDEST = 0.01, 0.1
WORTH_COST = {"flatten": 0.0005, "unwrap": 0.005}
HARDEST = 2
# What is dear in a map: its energy; in an atlas: the length of its seams, by that of a texel on the
# surface, so that seams which a higher density pays for cost nothing.
COST = {"flatten": "Energy", "unwrap": "Seams by texel"}
THINGS = {"flatten": "Maps", "unwrap": "Atlases"}


def cases(of: str | None = None) -> list[dict[str, Any]]:
    """Return the table of cases: those of a command, or all."""
    found: list[dict[str, Any]] = json.loads(CASES.read_text())
    return [case for case in found if of in (None, case.get("of", "flatten"))]


def check() -> list[str]:
    """Return what is wrong with the table: texts that a source does not have exactly once."""
    wrong = []
    for case in cases():
        count = (ROOT / case["file"]).read_text().count(case["from"])
        if count != 1:
            wrong.append(f"{case['name']}: {case['file']} has its text {count} times, not once")
    return wrong


def write_if_new(path: Path, text: bytes) -> None:
    """Write a file unless it has that text, so that nothing is compiled for nothing."""
    if path.exists() and path.read_bytes() == text:
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(text)


def build(case: dict[str, Any] | None) -> Path:
    """Compile the program without a case, or as it is, and return where it lies."""
    for name in COPIED:
        top = ROOT / name
        for source in [top] if top.is_file() else sorted(top.rglob("*")):
            if not source.is_file():
                continue
            place = source.relative_to(ROOT)
            text = source.read_bytes()
            if case and str(place) == case["file"]:
                text = text.decode().replace(case["from"], case["to"]).encode()
            write_if_new(TREE / place, text)
    out = WORK / "build"
    if not (out / "build.ninja").exists():
        options = ("BUILD_TESTS=OFF", "BUILD_STATIC=OFF", "INSTALL=OFF")
        subprocess.run(
            [
                "cmake",
                "-S",
                TREE,
                "-B",
                out,
                "-G",
                "Ninja",
                "-DCMAKE_BUILD_TYPE=Release",
            ]
            + [f"-DBELTRAMI_{option}" for option in options],
            check=True,
            stdout=subprocess.DEVNULL,
        )
    subprocess.run(["cmake", "--build", out], check=True, stdout=subprocess.DEVNULL)
    kept = WORK / "programs" / (case["name"] if case else "as-it-is")
    shutil.rmtree(kept, ignore_errors=True)
    kept.mkdir(parents=True)
    shutil.copy(out / "program" / "beltrami", kept)
    for library in (out / "src").glob("libbeltrami.so*"):
        shutil.copy(library, kept)
    return kept


def cost_of(told: dict[str, Any]) -> float | None:
    """Return what a report tells of what is dear in a map or an atlas."""
    if told["command"] == "flatten":
        return told["energy"] and told["energy"]["symmetric_dirichlet"]
    if not told["packing"]:
        return None
    # A surface that needs no seams has a border for all that, of about the root of its area.
    texels = told["packing"]["texels_per_unit"] * math.sqrt(told["admitted"]["area"])
    return (1 + told["seam_over_root_area"]) / texels


def run(program: Path, case: dict[str, Any], mesh: Path) -> dict[str, Any]:
    """Flatten or unwrap a mesh: the cost, the CPU without reading and writing, and the verdict."""
    folder = program / str(os.getpid())
    folder.mkdir(exist_ok=True)
    report = folder / f"{mesh.stem}.json"
    report.unlink(missing_ok=True)
    of = case.get("of", "flatten")
    command = [program / "beltrami", of, mesh, folder / f"{mesh.stem}.ply"]
    command += case.get("arguments", [])
    done = subprocess.run(
        [*command, "--threads", "1", "--quiet", "--report", report],
        env={**os.environ, "LD_LIBRARY_PATH": str(program)},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        check=False,
    )
    if done.returncode not in (0, 3) or not report.exists():
        return {"cost": None, "cpu": None, "ok": False}
    told = json.loads(report.read_text())
    spent = [s["cpu_seconds"] for s in told["stages"] if s["name"] not in ("read", "write")]
    reached = of == "flatten" or bool(told["target"] and told["target"]["reached"])
    return {
        "cost": cost_of(told),
        "cpu": sum(spent),
        "ok": done.returncode == 0 and reached,
    }


def measure(case: dict[str, Any], usual: Path, meshes: list[Path], jobs: int) -> list[dict]:
    """Run all meshes with the case and without it, in turns."""
    without = build(case)

    def both(mesh: Path) -> dict[str, Any]:
        row = {"case": case["name"], "mesh": mesh.stem}
        return row | {
            "with": run(usual, case, mesh),
            "without": run(without, case, mesh),
        }

    with ThreadPoolExecutor(jobs) as pool:
        rows = list(pool.map(both, meshes))
    shutil.rmtree(without)
    return rows


def ratio(row: dict[str, Any], what: str) -> float:
    """Return what it is without the case, relative to what it is with it."""
    with_it, without = row["with"][what], row["without"][what]
    return without / with_it if with_it and without else math.nan


def verdict(rows: list[dict[str, Any]], of: str) -> dict[str, Any]:
    """Return what a case is worth over its meshes."""
    hardest = sorted(rows, key=lambda row: -(row["with"]["cost"] or math.inf))[:HARDEST]
    lost = sum(row["with"]["ok"] and not row["without"]["ok"] for row in rows)
    won = sum(row["without"]["ok"] and not row["with"]["ok"] for row in rows)
    sound = [row for row in rows if not math.isnan(ratio(row, "cost"))]
    cpu = statistics.geometric_mean(ratio(row, "cpu") for row in sound)
    cost = statistics.geometric_mean(ratio(row, "cost") for row in sound)
    changed = sum(row["with"]["cost"] != row["without"]["cost"] for row in rows)
    worst = max(
        (max(ratio(row, "cpu"), ratio(row, "cost")) for row in hardest if row in sound),
        default=math.nan,
    )
    dear = cpu > 1 + WORTH_CPU or cost > 1 + WORTH_COST[of] or worst > 1 + WORTH_HARDEST
    return {
        "lost": lost - won,
        "cpu": cpu,
        "cost": cost,
        "worst": worst,
        "changed": changed,
        "stays": bool(changed) and (lost > won or dear),
    }


def read(record: Path) -> dict[str, list[dict[str, Any]]]:
    """Return the rows of the last run of each case."""
    rows: dict[str, dict[str, dict[str, Any]]] = defaultdict(dict)
    for line in record.read_text().splitlines():
        row = json.loads(line)
        rows[row["case"]][row["mesh"]] = row
    return {case: list(of_mesh.values()) for case, of_mesh in rows.items()}


def table(record: Path, of: str) -> Iterable[str]:
    """Yield the lines of the table, the most valuable case first."""
    rows = read(record)
    told = {case["name"]: case for case in cases(of)}
    judged = {name: verdict(of_case, of) for name, of_case in rows.items() if name in told}
    things = THINGS[of]
    yield f"| Case | Source | {things} changed | CPU | {COST[of]} | Hardest two | {things} lost |"
    yield "|---|---|---:|---:|---:|---:|---:|"
    for name in sorted(judged, key=lambda n: (-judged[n]["lost"], -judged[n]["cpu"])):
        is_worth, what = judged[name], told[name]["what"].rstrip(".")
        source = told[name]["file"].removeprefix("src/")
        yield (
            f"| {what} | `{source}` | {is_worth['changed']} of {len(rows[name])} "
            f"| {is_worth['cpu']:.3f} | {100 * (is_worth['cost'] - 1):+.3f}% "
            f"| {is_worth['worst']:.2f} | {is_worth['lost']} |"
        )


def write_table(page: Path, record: Path, of: str) -> None:
    """Put the table between the marks of a page."""
    text = page.read_text()
    begin, end = f"<!-- table of {of} -->\n", f"<!-- end of the table of {of} -->"
    before, rest = text.split(begin)
    lines = "\n".join(table(record, of))
    page.write_text(before + begin + lines + "\n" + end + rest.split(end)[1])


def main() -> int:
    """Do what the arguments say."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument(
        "meshes", nargs="*", type=Path, help="disks to flatten, or surfaces to unwrap"
    )
    parser.add_argument("--of", choices=("flatten", "unwrap"), default="flatten")
    parser.add_argument("--without", nargs="+", help="names of cases; all by default")
    parser.add_argument("--record", type=Path, help="file of lines that is added to")
    parser.add_argument("--table", type=Path, help="page whose table is written anew")
    parser.add_argument("--jobs", type=int, default=1, help="meshes at a time")
    parser.add_argument("--check", action="store_true", help="look at the table of cases only")
    given = parser.parse_args()
    wrong = check()
    for sentence in wrong:
        print(sentence, file=sys.stderr)
    if wrong or given.check:
        return 1 if wrong else 0
    if given.table:
        write_table(given.table, given.record, given.of)
        return 0
    usual = build(None)
    names = given.without or [case["name"] for case in cases(given.of)]
    for case in cases(given.of):
        if case["name"] not in names:
            continue
        rows = measure(case, usual, given.meshes, given.jobs)
        if given.record:
            with given.record.open("a") as record:
                record.writelines(json.dumps(row) + "\n" for row in rows)
        worth = verdict(rows, given.of)
        print(
            f"{case['name']}: CPU {worth['cpu']:.3f}, cost {100 * (worth['cost'] - 1):+.3f}%, "
            f"hardest {worth['worst']:.2f}, lost {worth['lost']}, changed {worth['changed']}: "
            f"{'stays' if worth['stays'] else 'goes'}",
            flush=True,
        )
    return 0


if __name__ == "__main__":
    sys.exit(main())
