"""The C++ library for WebAssembly: zig's own has neither exceptions nor locks.

Compiled from the sources that zig brings, with WebAssembly's exceptions, and locks for the threads
that JavaScript lends.
"""

from __future__ import annotations

import subprocess
from pathlib import Path

HERE = Path(__file__).resolve().parent
TARGET = "wasm32-wasi"
MACHINE = ["-mcpu=generic+atomics+exception_handling+simd128+bulk_memory"]

CONFIGURATION = {
    "_LIBCPP_ABI_VERSION": "1",
    "_LIBCPP_ABI_NAMESPACE": "__1",
    "_LIBCPP_HAS_THREADS": "1",
    "_LIBCPP_HAS_THREAD_API_EXTERNAL": "1",
    "_LIBCPP_HAS_MONOTONIC_CLOCK": "1",
    "_LIBCPP_HAS_TERMINAL": "0",
    "_LIBCPP_HAS_MUSL_LIBC": "1",
    "_LIBCPP_HAS_FILESYSTEM": "0",
    "_LIBCPP_HAS_RANDOM_DEVICE": "1",
    "_LIBCPP_HAS_LOCALIZATION": "1",
    "_LIBCPP_HAS_UNICODE": "1",
    "_LIBCPP_HAS_WIDE_CHARACTERS": "1",
    "_LIBCPP_HAS_TIME_ZONE_DATABASE": "0",
    "_LIBCPP_HAS_VENDOR_AVAILABILITY_ANNOTATIONS": "0",
    "_LIBCPP_PSTL_BACKEND_SERIAL": "",
    "_LIBCPP_DISABLE_VISIBILITY_ANNOTATIONS": "",
    "_LIBCXXABI_DISABLE_VISIBILITY_ANNOTATIONS": "",
    "_LIBCPP_HARDENING_MODE": "_LIBCPP_HARDENING_MODE_NONE",
    "_LIBCPP_ENABLE_CXX17_REMOVED_UNEXPECTED_FUNCTIONS": "",
}
LIBRARY = [
    "algorithm",
    "atomic",
    "charconv",
    "chrono",
    "condition_variable",
    "condition_variable_destructor",
    "error_category",
    "exception",
    "functional",
    "future",
    "hash",
    "memory",
    "mutex",
    "mutex_destructor",
    "new_handler",
    "new_helpers",
    "optional",
    "stdexcept",
    "string",
    "system_error",
    "thread",
    "vector",
    "verbose_abort",
    "ryu/d2fixed",
    "ryu/d2s",
    "ryu/f2s",
]
EXCEPTIONS = [
    "abort_message",
    "cxa_aux_runtime",
    "cxa_default_handlers",
    "cxa_exception",
    "cxa_exception_storage",
    "cxa_guard",
    "cxa_handlers",
    "cxa_personality",
    "cxa_vector",
    "cxa_virtual",
    "fallback_malloc",
    "private_typeinfo",
    "stdlib_exception",
    "stdlib_new_delete",
    "stdlib_stdexcept",
    "stdlib_typeinfo",
]


def flags(zig: Path) -> list[str]:
    """Return what a source in C++ is compiled with."""
    lib = zig.parent / "lib"
    places = [HERE / "include", lib / "libcxx/include", lib / "libcxxabi/include"]
    defined = [
        f"-D{name}={value}" if value else f"-D{name}" for name, value in CONFIGURATION.items()
    ]
    return [
        *MACHINE,
        "-fwasm-exceptions",
        "-fno-sanitize=undefined",
        "-nostdinc++",
        *(f"-I{place}" for place in places),
        *defined,
    ]


def build_malloc(zig: Path, target: Path) -> None:
    """Compile the malloc of zig's C library with the lock that it has for several threads.

    Its functions are weak there; the linker is to take these for certain.
    """
    source = str(zig.parent / "lib/libc/wasi/emmalloc/emmalloc.c")
    defined = ["-D__EMSCRIPTEN_PTHREADS__", "-Dweak=used", "-DNDEBUG"]
    words = [str(zig), "cc", "-target", TARGET, *MACHINE, "-g0", "-O2", "-w", *defined]
    subprocess.run([*words, "-c", source, "-o", str(target)], check=True)


def build(zig: Path, folder: Path) -> Path:
    """Compile the library into `folder`, unless it is there; return it."""
    library = folder / "libc++.a"
    if library.exists():
        return library
    lib = zig.parent / "lib"
    (folder / "objects").mkdir(parents=True, exist_ok=True)
    objects: list[str] = []

    def compile_source(tool: str, source: str, *extra: str) -> None:
        target = folder / "objects" / (source.replace("/", "_") + ".o")
        objects.append(str(target))
        common = [str(zig), tool, "-target", TARGET, "-g0", "-O2", "-DNDEBUG", "-w", *flags(zig)]
        subprocess.run([*common, *extra, "-c", str(lib / source), "-o", str(target)], check=True)

    inner = [f"-I{lib}/libcxx/src", f"-I{lib}/libcxx/libc", "-std=c++23"]
    for name in LIBRARY:
        building = ["-D_LIBCPP_BUILDING_LIBRARY", "-DLIBCXX_BUILDING_LIBCXXABI"]
        spaces = ["-DLIBC_NAMESPACE=__llvm_libc_common_utils"]
        compile_source("c++", f"libcxx/src/{name}.cpp", *building, *spaces, *inner)
    for name in EXCEPTIONS:
        building = ["-D_LIBCXXABI_BUILDING_LIBRARY"]
        ends = ["-DLIBCXXABI_NON_DEMANGLING_TERMINATE"]
        compile_source("c++", f"libcxxabi/src/{name}.cpp", *building, *ends, *inner)
    unwinding = [f"-I{lib}/libunwind/include", "-D__WASM_EXCEPTIONS__", "-D_LIBUNWIND_HIDE_SYMBOLS"]
    compile_source("cc", "libunwind/src/Unwind-wasm.c", *unwinding)
    unfinished = folder / "unfinished.a"
    unfinished.unlink(missing_ok=True)
    subprocess.run([str(zig), "ar", "rcsD", str(unfinished), *objects], check=True)
    unfinished.rename(library)
    return library
