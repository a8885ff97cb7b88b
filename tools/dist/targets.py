"""What is built for which platform."""

from __future__ import annotations

from dataclasses import dataclass

WASM = "wasm32"


@dataclass(frozen=True)
class Target:
    """A platform, as the names of archives have it, and as zig and wheels call it."""

    name: str
    zig: str
    wheel: str = ""  # the platform's tag; "" where no wheel is made
    archive: str = ".tar.gz"
    static: bool = False  # whether a static library is made, which brings its own C++ runtime

    @property
    def windows(self) -> bool:
        """Whether it has DLLs."""
        return "windows" in self.zig

    @property
    def macos(self) -> bool:
        """Whether it has dylibs."""
        return "macos" in self.zig

    @property
    def linux(self) -> bool:
        """Whether it has ELF files."""
        return "linux" in self.zig

    @property
    def options(self) -> dict[str, str]:
        """CMake's variables."""
        common = {
            "CMAKE_BUILD_TYPE": "Release",
            "BELTRAMI_ZIG_TARGET": self.zig,
            "BELTRAMI_EXACT": "own",
            "BELTRAMI_BUILD_TESTS": "OFF",
            "BELTRAMI_BUILD_STATIC": "ON" if self.static else "OFF",
        }
        if self.name == WASM:
            for name in ("BUILD_SHARED_LIBS", "BELTRAMI_BUILD_PROGRAM", "BELTRAMI_INSTALL"):
                common[name] = "OFF"
        return common


#: 2.17 is the C library of manylinux2014, and of every distribution since.
TARGETS = {
    target.name: target
    for target in (
        Target("x86_64-linux", "x86_64-linux-gnu.2.17", "manylinux_2_17_x86_64", static=True),
        Target("x86_64-windows", "x86_64-windows-gnu", "win_amd64", ".zip"),
        Target(WASM, "wasm32-wasi", "", ".tgz"),
        Target("aarch64-linux", "aarch64-linux-gnu.2.17", "manylinux_2_17_aarch64", static=True),
        Target("x86_64-linux-musl", "x86_64-linux-musl", "musllinux_1_2_x86_64"),
        Target("aarch64-linux-musl", "aarch64-linux-musl", "musllinux_1_2_aarch64"),
        Target("aarch64-macos", "aarch64-macos.11.0", "macosx_11_0_arm64"),
        Target("x86_64-macos", "x86_64-macos.11.0", "macosx_11_0_x86_64"),
    )
}
