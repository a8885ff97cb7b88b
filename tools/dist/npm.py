"""The npm package, the library as WebAssembly with what JavaScript needs to call it; and the page that uses it."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path

import archive
import checks
import inputs
import sbom
from targets import TARGETS, WASM
from wasm import runtime

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "bindings" / "npm"
SUFFIXES = {".mjs", ".ts", ".md"}  # of what the package has; types.d.ts is the beginning of index.d.ts
VIEWER = ROOT / "program" / "viewer"
STACK = 8 << 20  # bytes: as threads of Linux have
# Of the memory that the module imports, in bytes. index.mjs has both in pages.
FIRST_MEMORY, MOST_MEMORY = 256 << 16, 65535 << 16
#: What index.mjs and threads.mjs need of it to run it on several threads.
OF_THREADS = ["__stack_pointer", "__tls_size", "__wasm_init_tls"]
#: As WebAssembly writes that a module imports a memory, which is shared, or is not.
SHARED = b"\x03env\x06memory\x02\x03"
UNSHARED = b"\x03env\x06memory\x02\x01"
MOST_BYTES = 1_500_000  # of the package


def link(build: Path, runtime_library: Path, target: Path) -> Path:
    """Link the static library of a build into a module that exports the C interface.

    It is linked for memory that several threads share, and then says that its memory is not: so it
    runs everywhere, and threads.mjs takes that back where there are to be threads.
    """
    zig = str(inputs.zig_path())
    glue, malloc = build / "glue.o", build / "malloc.o"
    runtime.build_malloc(inputs.zig_path(), malloc)
    common = ["-target", runtime.TARGET, *runtime.MACHINE, "-g0", "-O2"]
    include = f"-I{ROOT / 'include'}"
    compiling = [zig, "cc", *common, include, "-c", str(PACKAGE / "glue.c"), "-o", str(glue)]
    subprocess.run(compiling, check=True)
    exports = [f"-Wl,--export={name}" for name in sorted(checks.symbols() | {"malloc", "free"})]
    exports += [f"-Wl,--export={name}" for name in OF_THREADS]
    memory = ["--import-memory", "--export-memory", "--shared-memory"]
    memory += [f"--initial-memory={FIRST_MEMORY}", f"--max-memory={MOST_MEMORY}"]
    libraries = [str(build / "src" / "libbeltrami.a"), str(runtime_library)]
    words = [zig, "c++", *common, "-s", "-mexec-model=reactor", "-nostdlib++", *exports]
    words += [*(f"-Wl,{word}" for word in memory), f"-Wl,-z,stack-size={STACK}"]
    words += [str(glue), str(malloc), *libraries, "-o", str(target)]
    subprocess.run(words, check=True)
    module = target.read_bytes()
    if module.count(SHARED) != 1:
        raise checks.CheckError(f"{target.name} does not import a shared memory")
    target.write_bytes(module.replace(SHARED, UNSHARED))
    return target


def pack(build: Path, dist: Path, out: Path, version: str) -> Path:
    """Assemble the package below `dist` and pack it as `npm pack` does; return the file."""
    stage = dist / "stage" / WASM
    shutil.rmtree(stage, ignore_errors=True)
    stage.mkdir(parents=True)
    link(build, dist / "runtime" / "libc++.a", stage / "beltrami.wasm")
    for path in sorted(PACKAGE.iterdir()):
        if path.suffix in SUFFIXES and path.name != "types.d.ts":
            shutil.copy(path, stage)
    shutil.copy(ROOT / "LICENSE", stage / "LICENSE")
    for licence in inputs.licences():
        shutil.copy(licence, stage / licence.name)
    description = json.loads((PACKAGE / "package.json").read_text()) | {"version": version}
    (stage / "package.json").write_text(json.dumps(description, indent=2) + "\n")
    sbom.write_sbom(stage, TARGETS[WASM], version, sbom.kinds_of(TARGETS[WASM]))
    packed = archive.pack(stage, out / f"beltrami-{version}.tgz", "package")
    if packed.stat().st_size > MOST_BYTES:
        raise checks.CheckError(f"{packed.name} has {packed.stat().st_size} bytes")
    return packed


def pack_page(dist: Path, out: Path, version: str) -> Path:
    """Assemble the page that unwraps in browsers, of the package in `dist`, and pack it; return the file."""
    stage = dist / "stage" / "page"
    shutil.rmtree(stage, ignore_errors=True)
    shutil.copytree(PACKAGE / "page", stage)
    (stage / "viewer").mkdir()
    for path in sorted(VIEWER.iterdir()):
        if path.suffix in {".mjs", ".css"}:
            shutil.copy(path, stage / "viewer")
    joined = ["-DPAGE=report.html", f"-DBYTES={dist / 'report_page.inc'}"]
    script = str(VIEWER / "join.cmake")
    subprocess.run(["cmake", *joined, "-P", script], cwd=stage / "viewer", check=True)
    shutil.copytree(dist / "stage" / WASM, stage / "beltrami")
    return archive.pack(stage, out / f"beltrami-{version}-page.zip", f"beltrami-{version}-page")
