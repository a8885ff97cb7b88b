#!/usr/bin/env python3
"""The gates of the binary interface. Each compares the header and the library at hand with what is
committed beside this script, and refuses any difference: README.md says what to do then.

    abi/gate.py types|symbols|constants|languages|client|imports|state [options]

Works on Linux with GCC, Clang, binutils and libabigail. A tool that is missing is a failure.
"""
import argparse
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import header as public_header

HERE = pathlib.Path(__file__).resolve().parent

# GCC and Clang both; -Wpadded, since a field added in old tail padding leaves sizeof as it was, and
# old callers would pass garbage.
LANGUAGES = ["c89", "c99", "c17", "c++98", "c++17", "c++20"]
STRICT = ["-pedantic-errors", "-Wall", "-Wextra", "-Wpadded", "-Werror"]

# What a library has no business with in its host's process.
UNWANTED_IMPORTS = {
    "prints": r"v?[fds]?n?printf(_chk)?|__\w*printf_chk|puts|putchar|putc|fputs|fputc|fwrite|perror"
              r"|write|stdout|stderr|_ZSt4cout|_ZSt4cerr|_ZSt4clog|_ZSt5wcout|_ZSt5wcerr|syslog",
    "reads or writes the environment": r"(secure_|__secure_)?getenv|setenv|unsetenv|putenv|environ",
    "changes signals": r"signal|sigaction|sigprocmask|pthread_sigmask|raise|kill|alarm|setitimer",
    "depends on the locale": r"setlocale|uselocale|localeconv|newlocale|strto[dfl]|ato[fil]|scanf",
    "ends the process or hooks into its end": r"exit|_exit|quick_exit|atexit|abort|__assert_fail",
    "has state for the whole process": r"s?rand(om)?(_r)?|chdir|umask|fork|dlopen|pthread_atfork",
    # And hands what a host's allocator gave to code that does not know it.
    "takes memory past the host's allocator":
        r"_Zn[wa]\w*|_Zd[la]\w*|calloc|realloc|posix_memalign|_ZNSt7__cxx1112basic_string\w*",
    "opens files": r"f?open(64)?|creat|tmpfile|mkstemp",
    # base/portable_math.h has those that it may use.
    "takes functions whose last bit depends on the processor":
        r"(c?(a?(sin|cos|tan)h?|exp|log|pow)|csqrt|sincos|atan2|exp(2|10|m1)|log(2|10|1p)|hypot|cbrt"
        r"|cabs|carg|[lt]gamma|erfc?)[fl]?|__div[sdx]c3",
}

# Statics of the headers that we include: constants once they are set; and
# the variables that src/base/interrupt.cpp and host_memory.cpp defend.
KNOWN_STATICS = [
    r"std::__ioinit",  # of <iostream>, which CGAL includes
    r"boost::none",
    r"beltrami::\(anonymous namespace\)::current",  # of a thread: its run, its memory
    r"boost::math::detail::.*(::initializer|::val)",  # limits of number types
    r"std::(detail|numeric_limits<boost).*(::init|::val)",
    r"Eigen::internal::manage_caching_sizes\(.*\)::m_cacheSizes",  # fixed: EIGEN_NO_CPUID
    # Of -DBELTRAMI_SIMPLIFIER=openmesh: what its module is called.
    r"OpenMesh::Decimater::ModQuadricT<.*>::name\(\) const::_s_modname_",
    r"completed\.\d+|__dso_handle|__TMC_END__|DW\.ref\..*|_GLOBAL_OFFSET_TABLE_|_DYNAMIC",
]


class Refusal(Exception):
    pass


def run(*command, **options):
    """Output of a command; its failure is a refusal."""
    command = [str(word) for word in command]
    if shutil.which(command[0]) is None:
        raise Refusal(f"{command[0]} is missing")
    done = subprocess.run(command, capture_output=True, text=True, check=False, **options)
    if done.returncode:
        raise Refusal(f"{' '.join(command)}\nfailed with {done.returncode}:\n"
                      f"{done.stdout}{done.stderr}".rstrip())
    return done.stdout


def difference(what, expected, found):
    """Complaints about a list that should be another one."""
    lines = [f"  - {line}" for line in expected if line not in set(found)]
    lines += [f"  + {line}" for line in found if line not in set(expected)]
    if lines:
        raise Refusal("\n".join([f"{what}:"] + lines))


def listed(path):
    lines = path.read_text(encoding="utf-8").splitlines()
    return [line for line in lines if line and not line.startswith("#")]


# ---- Types: sizes, offsets, parameters -----------------------------------------------------------

def dump_types(library, header, out):
    """Writes what libabigail knows of the exported functions. Types that the header does not define
    stay opaque, and nothing of this machine is in the dump."""
    include = pathlib.Path(header).parent.parent
    run("abidw", "--exported-interfaces-only", "--drop-private-types", "--headers-dir", include,
        "--no-show-locs", "--no-corpus-path", "--no-comp-dir-path", "--no-elf-needed",
        "--out-file", out, library)
    text = re.sub(r" path='[^']*/", " path='", out.read_text(encoding="utf-8"))
    out.write_text(text, encoding="utf-8")
    # Without debug information the dump has no types, and compares as equal to anything.
    defined = re.findall(r"<class-decl name='(\w+)' size-in-bits", text)
    wanted = public_header.read(header).structs()
    if not wanted or set(wanted) - set(defined):
        missing = ", ".join(sorted(set(wanted) - set(defined)))
        raise Refusal(f"the dump lacks {missing}: is the library built with -g?")


def gate_types(arguments):
    with tempfile.TemporaryDirectory() as folder:
        dump = pathlib.Path(folder) / "types.xml"
        dump_types(arguments.library, arguments.header, dump)
        run("abidiff", arguments.baseline / "types.xml", dump)


# ---- Symbols -------------------------------------------------------------------------------------

def defined_symbols(library, *flags):
    """Names of all global symbols but the version's own."""
    names = set()
    for line in run("nm", "--defined-only", "--format=posix", *flags, library).splitlines():
        fields = line.split()
        if len(fields) >= 2 and fields[1] != "A":
            names.add(fields[0].split("@")[0])
    return sorted(names)


def gate_symbols(arguments):
    expected = listed(arguments.baseline / "symbols.txt")
    declared = sorted(function.name for function in public_header.read(arguments.header).functions)
    difference("the header declares other functions than symbols.txt lists", expected, declared)
    difference("the shared library exports other symbols", expected,
               defined_symbols(arguments.library, "-D"))
    if arguments.static:
        difference("the static library has other global symbols", expected,
                   defined_symbols(arguments.static, "-g"))
    for path in arguments.export_list or []:
        found = re.findall(r"\b_?(beltrami_\w+)", path.read_text(encoding="utf-8"))
        difference(f"{path.name} exports other symbols", expected, found)


# ---- Constants -----------------------------------------------------------------------------------

def constants(header, compiler):
    """Lines "NAME NUMBER" for every enumerator and number macro, as the compiler sees them."""
    names = public_header.read(header).constants()
    with tempfile.TemporaryDirectory() as folder:
        source = pathlib.Path(folder) / "constants.c"
        program = source.with_suffix("")
        prints = "\n".join(
            f'  printf("{name} %s%llu\\n", {name} < 0 ? "-" : "",\n'
            f"         {name} < 0 ? 0ull - (unsigned long long){name} : {name});"
            for name in names)
        source.write_text("#include <beltrami/beltrami.h>\n#include <stdio.h>\n"
                          f"int main(void) {{\n{prints}\n  return 0;\n}}\n", encoding="utf-8")
        run(compiler, "-w", "-I", header.parent.parent, source, "-o", program)
        return run(program).splitlines()


def gate_constants(arguments):
    found = constants(arguments.header, arguments.cc)
    difference("constants changed", listed(arguments.baseline / "constants.txt"), found)
    values = dict(line.split() for line in found)
    for enum in public_header.read(arguments.header).enums():
        # Without it bindings see an unsigned enum where all members are positive, and MSVC a
        # signed one.
        if "-1" not in (values[name] for name in enum):
            raise Refusal(f"the enum of {enum[0]} has no member of value -1")


# ---- The header in six languages, with two compilers ---------------------------------------------

def gate_languages(arguments):
    text = "#include <beltrami/beltrami.h>\n#include <beltrami/beltrami.h>\n"
    for standard in LANGUAGES:
        is_c = "+" not in standard
        flags = STRICT + (["-Wstrict-prototypes"] if is_c else [])
        for compiler in ("gcc", "clang") if is_c else ("g++", "clang++"):
            run(compiler, f"-std={standard}", *flags, "-fsyntax-only", "-x", "c" if is_c else "c++",
                "-I", arguments.header.parent.parent, "-", input=text)


# ---- Old clients ---------------------------------------------------------------------------------

def gate_client(arguments):
    current = dict(line.split() for line in constants(arguments.header, arguments.cc))
    tested = 0
    for folder in sorted((arguments.baseline / "released").iterdir()):
        frozen = folder / "beltrami" / "beltrami.h"
        numbers = dict(line.split() for line in constants(frozen, arguments.cc))
        if numbers["BELTRAMI_ABI"] != current["BELTRAMI_ABI"]:
            continue  # an older interface, which the library's name already keeps apart
        tested += 1
        run_client(folder, frozen, arguments)
    if not tested:
        raise Refusal(f"no client of ABI {current['BELTRAMI_ABI']} in released/")


def run_client(folder, frozen, arguments):
    library = arguments.library.resolve()
    with tempfile.TemporaryDirectory() as scratch:
        client_object = pathlib.Path(scratch) / "client.o"
        client = pathlib.Path(scratch) / "client"
        run(arguments.cc, "-std=c89", "-pedantic-errors", "-Wall", "-Werror", "-c", "-I", folder,
            folder / "client.c", "-o", client_object)
        wanted = run("nm", "--undefined-only", "--format=posix", client_object).split()
        difference(f"{folder.name}/client.c does not use what its header declares",
                   sorted(function.name for function in public_header.read(frozen).functions),
                   sorted(name for name in wanted if name.startswith("beltrami_")))
        # By the name that the client will carry for good, so that a lost SONAME shows, too.
        run(arguments.cc, client_object, library, f"-Wl,-rpath,{library.parent}", "-lm",
            "-o", client)
        run(client)


# ---- Manners in a host's process -----------------------------------------------------------------

def gate_imports(arguments):
    complaints = []
    for line in run("nm", "-D", "--undefined-only", "--format=posix",
                    arguments.library).splitlines():
        name = line.split()[0].split("@")[0]
        complaints += [f"it {what}: imports {name}" for what, pattern in UNWANTED_IMPORTS.items()
                       if re.fullmatch(pattern, name)]
    if complaints:
        raise Refusal("\n".join(complaints))


def gate_state(arguments):
    known = re.compile("|".join(f"(guard variable for )?({text})" for text in KNOWN_STATICS))
    found = []
    for line in run("nm", "-C", arguments.library).splitlines():
        match = re.match(r"\S* +([bBdDuV]) (.*)", line)
        if not match or known.fullmatch(match[2]):
            continue
        found.append(match[2])
    writable = writable_symbols(arguments.library)
    found = [name for name in found if name in writable]
    if found:
        raise Refusal("\n".join(["it has state of its own, shared by all contexts:"] + found))


def writable_symbols(library):
    """Names in sections that stay writable: not those that the loader seals after relocation."""
    names = set()
    for line in run("objdump", "-t", "-C", library).splitlines():
        match = re.match(r"[0-9a-f]+ .{7} (\S+)\t[0-9a-f]+ +(.*)", line)
        if match and re.match(r"\.(data|bss|tbss|tdata)(?!\.rel\.ro)", match[1]):
            names.add(re.sub(r"^\.hidden ", "", match[2]))
    return names


GATES = {name[len("gate_"):]: gate for name, gate in globals().items() if name.startswith("gate_")}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("gate", choices=GATES)
    parser.add_argument("--library", type=pathlib.Path, help="the shared library")
    parser.add_argument("--static", type=pathlib.Path, help="the static library")
    parser.add_argument("--export-list", type=pathlib.Path, action="append",
                        help="a linker's list of exported symbols")
    parser.add_argument("--header", type=pathlib.Path, default=public_header.HEADER)
    parser.add_argument("--baseline", type=pathlib.Path, default=HERE, help="what is committed")
    parser.add_argument("--cc", default="cc")
    arguments = parser.parse_args()
    try:
        GATES[arguments.gate](arguments)
    except Refusal as refusal:
        print(f"abi/gate.py {arguments.gate}: {refusal}\n"
              "If this is meant, read abi/README.md and run ./dev abi.", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
