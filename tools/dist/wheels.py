"""Wheels: one for all Pythons of a platform, with the library and the program of its archive."""

from __future__ import annotations

import base64
import hashlib
import re
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import archive
import checks
import inputs
import tomllib
from targets import Target

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "bindings" / "python"
OLDEST = "cp39"
#: Of Python's own configuration what its limited interface looks at, for 64-bit Windows.
WINDOWS_CONFIGURATION = """#pragma once
#define MS_WINDOWS
#define MS_WIN32
#define MS_WIN64
#define HAVE_DECLSPEC_DLL 1
#define Py_ENABLE_SHARED 1
#define HAVE_STDARG_PROTOTYPES 1
#define SIZEOF_SHORT 2
#define SIZEOF_INT 4
#define SIZEOF_LONG 4
#define SIZEOF_LONG_LONG 8
#define SIZEOF_VOID_P 8
#define SIZEOF_SIZE_T 8
#define SIZEOF_TIME_T 8
#define SIZEOF_PID_T 4
#define SIZEOF_WCHAR_T 2
#define SIZEOF_FLOAT 4
#define SIZEOF_DOUBLE 8
#define ALIGNOF_MAX_ALIGN_T 8
"""


def pack(target: Target, dist: Path, out: Path, version: str) -> Path:
    """Build the extension module of a target, and pack a wheel of what its archive has."""
    stage, work = dist / "stage" / target.name, dist / "wheel" / target.name
    work.mkdir(parents=True, exist_ok=True)
    files: dict[str, tuple[bytes, int]] = {}
    for path in sorted((PACKAGE / "src" / "beltrami").iterdir()):
        if path.is_file():
            files[f"beltrami/{path.name}"] = (path.read_bytes(), 0o644)
    page = dist / target.name / "program" / "viewer" / "report.html"
    files[f"beltrami/{page.name}"] = (page.read_bytes(), 0o644)
    if target.windows:
        module = _module(target, work, stage / "lib" / "beltrami.lib", dist)
        compiled = {
            "_native.pyd": module,
            "beltrami.dll": stage / "bin" / "beltrami.dll",
            "beltrami.exe": stage / "bin" / "beltrami.exe",
        }
    else:
        shared = "libbeltrami.1.dylib" if target.macos else "libbeltrami.so.1"
        library = next(stage.glob(f"lib*/{shared}"))
        module = _module(target, work, library, dist)
        compiled = {
            "_native.abi3.so": module,
            shared: library,
            "bin/beltrami": stage / "bin" / "beltrami",
        }
    for name, path in compiled.items():
        files[f"beltrami/{name}"] = (path.read_bytes(), 0o755)
    info = f"beltrami-{version}.dist-info"
    for path in [ROOT / "LICENSE", *inputs.licences()]:
        files[f"{info}/licenses/{path.name}"] = (path.read_bytes(), 0o644)
    files[f"{info}/sboms/beltrami.spdx.json"] = ((stage / "sbom.spdx.json").read_bytes(), 0o644)
    _describe(files, info, version, target.wheel)
    name = f"beltrami-{version}-{OLDEST}-abi3-{target.wheel}.whl"
    wheel = archive.write_zip(out / name, files)
    if target.wheel.startswith("manylinux") and target.wheel.endswith("x86_64"):
        _audit(wheel, target.wheel)
    return wheel


def _headers(target: Target, folder: Path) -> Path:
    """Return Python's headers, with the configuration of the target."""
    place = folder / ("python-windows" if target.windows else "python-linux")
    if not place.exists():
        shutil.copytree(sysconfig.get_path("include"), place)
        if target.windows:
            (place / "pyconfig.h").write_text(WINDOWS_CONFIGURATION)
    return place


def _module(target: Target, work: Path, library: Path, dist: Path) -> Path:
    """Compile the module between Python and the library."""
    zig = str(inputs.zig_path())
    source, compiled = work / "_native.c", work / "_native.o"
    writer = [sys.executable, "-B", str(PACKAGE / "tools" / "write_native.py")]
    subprocess.run([*writer, "--core", str(ROOT), str(source)], check=True)
    include = [f"-I{ROOT / 'include'}", f"-I{_headers(target, dist)}"]
    common = [
        zig,
        "cc",
        "-target",
        target.zig,
        "-g0",
        "-O2",
        "-DNDEBUG",
        "-fno-sanitize=undefined",
        "-w",
    ]
    defined = ["-DPy_LIMITED_API=0x03090000", *(["-DBELTRAMI_SHARED"] if target.windows else [])]
    pic = [] if target.windows else ["-fPIC"]
    compiling = [*common, *pic, *defined, *include, "-c", str(source), "-o", str(compiled)]
    subprocess.run(compiling, check=True)
    if target.windows:
        module, extra = work / "_native.pyd", [str(_python_library(zig, compiled, work))]
    elif target.macos:
        module = work / "_native.abi3.so"
        extra = ["-Wl,-rpath,@loader_path", "-Wl,-undefined,dynamic_lookup"]
    else:
        module = work / "_native.abi3.so"
        extra = ["-Wl,-rpath,$ORIGIN", "-Wl,-soname,_native.abi3.so"]
    linking = [*common, "-shared", "-s", str(compiled), str(library), *extra, "-o", str(module)]
    subprocess.run(linking, check=True)
    return module


def _python_library(zig: str, compiled: Path, work: Path) -> Path:
    """Return an import library of python3.dll with what a module calls of it."""
    table = subprocess.run(
        ["objdump", "-t", str(compiled)], capture_output=True, text=True, check=True
    )
    names = sorted(set(re.findall(r"(?:__imp_)?(_?Py\w+)$", table.stdout, re.M)))
    wanted = [name for name in names if f"__imp_{name}" in table.stdout]
    definition, library = work / "python3.def", work / "libpython3.a"
    definition.write_text("LIBRARY python3.dll\nEXPORTS\n" + "".join(f"  {n}\n" for n in wanted))
    making = [zig, "dlltool", "-m", "i386:x86-64", "-d", str(definition), "-l", str(library)]
    subprocess.run(making, check=True)
    return library


def _describe(files: dict[str, tuple[bytes, int]], info: str, version: str, tag: str) -> None:
    """Add what installers read."""
    project = tomllib.loads((PACKAGE / "pyproject.toml").read_text())["project"]
    lines = ["Metadata-Version: 2.4", "Name: beltrami", f"Version: {version}"]
    lines += [f"Summary: {project['description']}", f"License-Expression: {project['license']}"]
    lines += ["License-File: LICENSE"]
    lines += [f"License-File: {path.name}" for path in inputs.licences()]
    lines += [f"Requires-Python: {project['requires-python']}"]
    lines += [f"Classifier: {classifier}" for classifier in project["classifiers"]]
    lines += [f"Requires-Dist: {need}" for need in project["dependencies"]]
    for extra, needs in project["optional-dependencies"].items():
        lines.append(f"Provides-Extra: {extra}")
        lines += [f'Requires-Dist: {need}; extra == "{extra}"' for need in needs]
    readme = (PACKAGE / "README.md").read_text()
    text = "\n".join([*lines, "Description-Content-Type: text/markdown", "", readme])
    files[f"{info}/METADATA"] = (text.encode(), 0o644)
    wheel = "Wheel-Version: 1.0\nGenerator: beltrami-dist\nRoot-Is-Purelib: false\n"
    wheel += f"Tag: {OLDEST}-abi3-{tag}\n"
    files[f"{info}/WHEEL"] = (wheel.encode(), 0o644)
    scripts = "".join(f"{name} = {entry}\n" for name, entry in project["scripts"].items())
    files[f"{info}/entry_points.txt"] = (f"[console_scripts]\n{scripts}".encode(), 0o644)
    record = ""
    for name, (data, _mode) in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        record += f"{name},sha256={digest},{len(data)}\n"
    files[f"{info}/RECORD"] = (f"{record}{info}/RECORD,,\n".encode(), 0o644)


def _audit(wheel: Path, tag: str) -> None:
    """Raise CheckError unless auditwheel finds that a wheel runs where its tag says."""
    asked = [sys.executable, "-m", "auditwheel", "show", str(wheel)]
    said = subprocess.run(asked, capture_output=True, text=True, check=False)
    text = " ".join((said.stdout + said.stderr).split())
    if f'platform tag: "{tag}"' not in text:
        raise checks.CheckError(f"auditwheel does not find {tag}: {text}")
