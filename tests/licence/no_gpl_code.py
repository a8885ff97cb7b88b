#!/usr/bin/env python3
"""Whether GPL code is in the library or linked by it, and whether the library says so.

    no_gpl_code.py --build FOLDER --library LIBRARY --info PROGRAM

Looks at every header that an object of the library was compiled from, as ninja recorded them, at
the shared libraries that the library needs, and at the first line of PROGRAM, which prints
beltrami_build_info(). Without GPL code the line must say "links no GPL code", with it "links GPL
code"; without CGAL's numbers and CHOLMOD, which are under the LGPL, "no LGPL code".
"""
import argparse
import pathlib
import re
import subprocess
import sys

OBJECTS = re.compile(r"src/CMakeFiles/beltrami_\w+\.dir/\S+\.(o|gch):")  # a precompiled header has most of them
# What a library without GPL code may need at run time: what every C++ program needs.
ALLOWED = re.compile(r"lib(stdc\+\+|m|gcc_s|c|pthread)\.so\.\d+|ld-linux\S*")
# And what it may need where it says "simplifier openmesh", and nowhere else.
OPENMESH = re.compile(r"libOpenMesh(Core|Tools)\.so\S*")


def headers_of(build):
    text = subprocess.run(["ninja", "-C", build, "-t", "deps"], capture_output=True, text=True,
                          check=True).stdout
    headers, ours = set(), False
    for line in text.splitlines():
        if not line.startswith(" "):
            ours = bool(OBJECTS.match(line))
        elif ours:
            headers.add((build / line.strip()).resolve())
    return headers


def is_gpl(header):
    """Under the GPL without an exception for those who include it (as the headers of the kernel and
    of the C++ library have), where no other licence is offered."""
    text = header.read_text(encoding="utf-8", errors="replace")
    for licences in re.findall(r"SPDX-License-Identifier:\s*(.*)", text):
        return bool(re.match(r"\(*GPL", licences)) and " WITH " not in licences
    if header.name.startswith("cholmod"):
        return True  # with its module Supernodal
    head = text[:4000]
    return ("GNU General Public License" in head and "Lesser" not in head
            and "Mozilla" not in head and "GCC Runtime Library Exception" not in text[:8000])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", type=pathlib.Path, required=True)
    parser.add_argument("--library", type=pathlib.Path, required=True)
    parser.add_argument("--info", type=pathlib.Path, required=True)
    arguments = parser.parse_args()

    headers = headers_of(arguments.build)
    if not any("Eigen" in header.parts for header in headers):
        sys.exit("ninja names no header of Eigen: nothing was looked at")
    lgpl = any("CGAL" in header.parts or header.name.startswith("cholmod") for header in headers)
    dynamic = subprocess.run(["readelf", "-d", arguments.library], capture_output=True, text=True,
                             check=True).stdout
    needed = re.findall(r"\(NEEDED\).*\[(.*)\]", dynamic)
    line = subprocess.run([arguments.info], capture_output=True, text=True,
                          check=True).stdout.splitlines()[0]
    allowed = [ALLOWED, OPENMESH] if "simplifier openmesh" in line else [ALLOWED]
    found = [str(header) for header in sorted(headers) if is_gpl(header)]
    found += [library for library in needed
              if not any(names.fullmatch(library) for names in allowed)]

    says = "links GPL code" in line
    if says == ("links no GPL code" in line):
        sys.exit(f"beltrami_build_info() says neither or both: {line}")
    print(f"{line}\n{len(headers)} headers, needs {', '.join(needed)}")
    if not says and lgpl == ("no LGPL code" in line):
        sys.exit("the library has LGPL code and does not say so, or says so and has none")
    if says and not found:
        sys.exit("the library says that it links GPL code, but there is none")
    if not says and found:
        sys.exit("GPL code, or code that nobody has looked at:\n" + "\n".join(found))


if __name__ == "__main__":
    main()
