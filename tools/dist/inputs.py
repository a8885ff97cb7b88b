"""What the binaries are made of beside beltrami: found on this machine, or fetched by apt."""

from __future__ import annotations

import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

#: Debian packages of headers, by the folder below /usr/include.
HEADERS = {
    "CLI": "libcli11-dev",
    "nlohmann": "nlohmann-json3-dev",
    "stb": "libstb-dev",
}
#: Licences of what only other builds hold.
NOT_HELD = {"GPL-3.0.txt", "LGPL-3.0.txt"}
SOURCES = """Types: deb-src
URIs: {uri}
Suites: {suite}
Components: main
Signed-By: /usr/share/keyrings/debian-archive-keyring.gpg
"""


@dataclass(frozen=True)
class Part:
    """A dependency, for the bill of materials."""

    name: str
    package: str  # Debian's, whose version is that of the part; or ziglang, from PyPI
    licence: str
    url: str
    where: str  # "library", "program", "runtime" or "wasm"


PARTS = (
    Part("Eigen", "libeigen3-dev", "MPL-2.0", "https://eigen.tuxfamily.org", "library"),
    Part("CLI11", "libcli11-dev", "BSD-3-Clause", "https://github.com/CLIUtils/CLI11", "program"),
    Part(
        "JSON for Modern C++",
        "nlohmann-json3-dev",
        "MIT",
        "https://github.com/nlohmann/json",
        "program",
    ),
    Part("stb", "libstb-dev", "MIT OR Unlicense", "https://github.com/nothings/stb", "program"),
    Part("zlib", "zlib1g-dev", "Zlib", "https://zlib.net", "program"),
    Part(
        "LLVM libc++, libc++abi, libunwind and compiler-rt",
        "ziglang",
        "Apache-2.0 WITH LLVM-exception",
        "https://libcxx.llvm.org",
        "runtime",
    ),
    Part(
        "C library parts that zig links: mingw-w64 (Windows), wasi-libc (WebAssembly)",
        "ziglang",
        "ZPL-2.1 AND MIT",
        "https://ziglang.org",
        "runtime",
    ),
)


def version_of(package: str) -> str:
    """Return the version of a Debian package or of zig, such as "3.4.0-4"."""
    if package == "ziglang":
        zig = subprocess.run([zig_path(), "version"], capture_output=True, text=True, check=True)
        return zig.stdout.strip()
    asked = ["dpkg-query", "-W", "-f", "${Version}", package]
    return subprocess.run(asked, capture_output=True, text=True, check=True).stdout.strip()


def licences() -> list[Path]:
    """Return the texts that go with a binary beside LICENSE."""
    folder = Path(__file__).resolve().parents[2] / "licenses"
    return sorted(path for path in folder.iterdir() if path.name not in NOT_HELD)


def zig_path() -> Path:
    """Return zig's program, of the package ziglang beside this Python."""
    import ziglang

    return Path(ziglang.__file__).resolve().parent / "zig"


def gather(folder: Path) -> Path:
    """Fill a folder with headers, apart from those of this machine's C library, and with zlib."""
    include = folder / "include"
    include.mkdir(parents=True, exist_ok=True)
    for name in HEADERS:
        place = include / name
        if not place.is_symlink():
            place.symlink_to(Path("/usr/include") / name)
    if not (folder / "zlib" / "deflate.c").exists():
        _fetch_zlib(folder)
    return folder


def _mirror() -> str:
    """Return the address that apt has of Debian's archive."""
    for part in [Path("/etc/apt/sources.list"), *Path("/etc/apt/sources.list.d").glob("*")]:
        if not part.is_file():
            continue
        for word in part.read_text().split():
            if word.startswith("http") and word.rstrip("/").endswith("/debian"):
                return word
    return "http://deb.debian.org/debian"


def _fetch_zlib(folder: Path) -> None:
    """Have apt fetch zlib's source and check its signature, in a state of its own."""
    apt = folder / "apt"
    for name in ("lists/partial", "cache/archives/partial"):
        (apt / name).mkdir(parents=True, exist_ok=True)
    suite = "bookworm"
    for line in Path("/etc/os-release").read_text().splitlines():
        if line.startswith("VERSION_CODENAME="):
            suite = line.split("=")[1].strip('"')
    (apt / "debian.sources").write_text(SOURCES.format(uri=_mirror(), suite=suite))
    options = {
        "Dir::Etc::sourcelist": apt / "debian.sources",
        "Dir::Etc::sourceparts": "-",
        "Dir::State::Lists": apt / "lists",
        "Dir::Cache": apt / "cache",
        "APT::Sandbox::User": "root",
    }
    words = ["apt-get", "-qq", *(f"-o{name}={value}" for name, value in options.items())]
    subprocess.run([*words, "update"], check=True)
    subprocess.run([*words, "source", "--download-only", "zlib"], check=True, cwd=apt)
    (folder / "zlib").mkdir(exist_ok=True)
    archive = next(apt.glob("zlib_*.orig.tar.*"))
    unpack = ["tar", "-xf", str(archive), "-C", str(folder / "zlib"), "--strip-components=1"]
    subprocess.run(unpack, check=True)
    shutil.rmtree(apt)
