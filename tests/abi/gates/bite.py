#!/usr/bin/env python3
"""Breaks the interface in one way and requires that the gate meant for it refuses.

    bite.py --library LIBRARY CASE

A stand-in for the library is compiled from a copy of the header: each function hands its call on to
the real library. The case changes the copy or the stand-in, and abi/gate.py, the script of the real
gates, judges both against what is committed. Each case first runs its gate on the unchanged
stand-in, which must pass: a gate that refuses everything proves nothing.
"""
import argparse
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "abi"))
import header as public_header  # noqa: E402

EXTRA = "extern \"C\" __attribute__((visibility(\"default\")))"


def replaced(text, old, new):
    if text.count(old) != 1:
        raise SystemExit(f"bite.py: the header has {text.count(old)} times: {old}")
    return text.replace(old, new)


# Per case: the gate, what becomes of the header's text, of the stand-in's source, of its list of
# exports, and a word of the refusal.
CASES = {
    "removed-function": {
        "gates": ["symbols", "types", "client"],
        "header": lambda text: re.sub(
            r"BELTRAMI_API beltrami_status beltrami_set_float\(.*?\);", "", text, flags=re.DOTALL),
        "says": "beltrami_set_float"},
    "member-inserted-mid-struct": {
        "gates": ["types"],
        "header": lambda text: replaced(text, "  uint64_t coarse_faces;",
                                        "  uint64_t seams;\n  uint64_t coarse_faces;"),
        "says": "beltrami_result"},
    "widened-parameter": {
        "gates": ["types"],
        "header": lambda text: text.replace("beltrami_set_float(beltrami_context* context, int32_t",
                                            "beltrami_set_float(beltrami_context* context, int64_t"),
        "says": "beltrami_set_float"},
    "renumbered-constant": {
        "gates": ["constants"],
        "header": lambda text: replaced(text, "BELTRAMI_E_CLOSED = -28", "BELTRAMI_E_CLOSED = -32"),
        "says": "BELTRAMI_E_CLOSED"},
    "leaked-symbol": {
        "gates": ["symbols"],
        "source": lambda text: text + f"{EXTRA} int cholmod_start() {{ return 1; }}\n",
        "exports": lambda names: names + ["cholmod_start"],
        "says": "cholmod_start"},
    "hidden-padding": {
        "gates": ["languages"],
        "header": lambda text: replaced(text, "  int32_t reserved;            /* 0 */\n", ""),
        "says": "pad"},
    "a-comment-of-c++": {
        "gates": ["languages"],
        "header": lambda text: text.replace("typedef int32_t", "// signed\ntypedef int32_t", 1),
        "says": "C++ style comments"},
    "an-enum-without-minus-one": {
        "gates": ["constants"],
        "header": lambda text: replaced(text, "BELTRAMI_TYPE_FORCE_SIGNED_ = -1",
                                        "BELTRAMI_TYPE_FORCE_SIGNED_ = 3"),
        "says": "BELTRAMI_TYPE_FORCE_SIGNED_"},
    "written-behind-a-struct": {
        "gates": ["client"],
        "source": lambda text: text.replace(
            "/* after beltrami_get_result */", "if (out) reinterpret_cast<char*>(out + 1)[3] = 0;"),
        "says": "canary"},
    "a-client-that-forgets-a-function": {
        "gates": ["client"],
        "client": lambda text: text.replace("REQUIRE(beltrami_stage_count(context) > 0);", ""),
        "says": "beltrami_stage_count"},
    "another-soname": {
        "gates": ["types"],
        "soname": "libbeltrami.so.2",
        "says": "SONAME"},
    "no-debug-information": {
        "gates": ["types"],
        "flags": ["-g0"],
        "says": "is the library built with -g"},
    "prints": {
        "gates": ["imports"],
        "source": lambda text: text.replace(
            "/* after beltrami_version */", '__builtin_puts("hello");'),
        "says": "it prints: imports puts"},
    "reads-the-environment": {
        "gates": ["imports"],
        "source": lambda text: "#include <cstdlib>\n" + text.replace(
            "/* after beltrami_version */", 'if (getenv("BELTRAMI_DEBUG")) return 0;'),
        "says": "imports getenv"},
    "takes-the-sine-of-the-system": {
        "gates": ["imports"],
        "source": lambda text: "#include <cmath>\n" + text.replace(
            "/* after beltrami_set_float */", "if (std::sin(value) > 2) return result;"),
        "says": "imports sin"},
    "allocates-by-the-operators-of-all": {
        "gates": ["imports"],
        "source": lambda text: "#include <new>\n" + text.replace(
            "/* after beltrami_version */", "::operator delete(::operator new(1));"),
        "says": "takes memory past the host's allocator: imports _Znwm"},
    "global-state": {
        "gates": ["state"],
        "source": lambda text: "static int calls;\n" + text.replace(
            "/* after beltrami_version */", "++calls;"),
        "says": "calls"},
}


def stand_in(header):
    """Source of a library that hands every call on to the real one."""
    lines = ["#include <beltrami/beltrami.h>", "#include <dlfcn.h>",
             "struct beltrami_context { int unused; };", "namespace {",
             "void* real(const char* name) {", "  return dlsym(dlopen(REAL, RTLD_NOW), name);", "}",
             "}"]
    for function in header.functions:
        parameters = ", ".join(function.parameters) or "void"
        call = (f"reinterpret_cast<{function.result} (*)({parameters})>(real(\"{function.name}\"))"
                f"({', '.join(function.parameter_names())})")
        keep, give = ("", "") if function.result == "void" else ("auto result = ", "return result;")
        lines.append(f"{function.result} {function.name}({parameters}) {{\n  {keep}{call};\n"
                     f"  /* after {function.name} */\n  {give}\n}}")
    return "\n".join(lines) + "\n"


def unchanged(thing):
    return thing


def build(folder, library, case):
    """Writes header, library and baseline into `folder`; returns options for abi/gate.py."""
    header = folder / "include" / "beltrami" / "beltrami.h"
    header.parent.mkdir(parents=True)
    header.write_text(case.get("header", unchanged)(public_header.HEADER.read_text()))
    parsed = public_header.read(header)

    source = folder / "stand_in.cpp"
    source.write_text(case.get("source", unchanged)(stand_in(parsed)))
    names = case.get("exports", unchanged)([function.name for function in parsed.functions])
    exports = folder / "exports.map"
    exports.write_text("BELTRAMI_1 { global: " + " ".join(name + ";" for name in names) +
                       " local: *; };\n")
    result = folder / "libbeltrami.so.1"
    subprocess.run(["g++", "-std=c++20", "-g", *case.get("flags", []), "-shared", "-fPIC",
                    "-fvisibility=hidden", "-DBELTRAMI_BUILDING", f'-DREAL="{library}"',
                    "-I", header.parent.parent, source, "-o", result,
                    f"-Wl,--version-script={exports}",
                    f"-Wl,-soname,{case.get('soname', 'libbeltrami.so.1')}"], check=True)

    baseline = folder / "abi"
    subprocess.run(["cp", "-r", ROOT / "abi", baseline], check=True)
    for client in baseline.glob("released/*/client.c"):
        client.write_text(case.get("client", unchanged)(client.read_text()))
    return ["--library", result, "--header", header, "--baseline", baseline]


def judge(gate, options):
    return subprocess.run([sys.executable, ROOT / "abi" / "gate.py", gate, *options],
                          capture_output=True, text=True, check=False)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--library", type=pathlib.Path, required=True)
    parser.add_argument("case", choices=CASES)
    arguments = parser.parse_args()
    case = CASES[arguments.case]
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        sound = build(folder / "sound", arguments.library.resolve(), {})
        broken = build(folder / "broken", arguments.library.resolve(), case)
        for gate in case["gates"]:
            done = judge(gate, sound)
            allowed = gate == "imports"  # the stand-in itself calls dlopen
            if (done.returncode and not allowed) or case["says"] in done.stderr:
                sys.exit(f"{gate} refuses what is sound:\n{done.stderr}")
            done = judge(gate, broken)
            if done.returncode != 1 or case["says"] not in done.stderr:
                sys.exit(f"{gate} does not see {arguments.case}; it ended with {done.returncode}:\n"
                         f"{done.stdout}{done.stderr}")
            print(f"{gate} refuses {arguments.case}")


if __name__ == "__main__":
    main()
