#!/usr/bin/env bash
# Builds the wheel as others do: from the sdist alone, in a folder outside the checkout; then tags
# it with the oldest systems that it runs on, and refuses it if those are not old enough.
#   wheel.sh PYTHON FOLDER
# PYTHON is that of an environment with requirements/tools.txt. FOLDER gets sdist/ and wheel/, and
# keeps the compiler's results for the next time. With BELTRAMI_BUILT, a build folder of the same sources,
# the objects of the library are taken from there.
set -euo pipefail
PYTHON=$(realpath --no-symlinks "$1")
OUT=$(realpath "$2")
readonly PYTHON OUT
HERE=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
readonly HERE
outside=$(mktemp -d)
readonly outside
launcher=ccache
if [[ -n ${BELTRAMI_BUILT:-} ]]; then launcher=$HERE/../../tests/install/reuse_object.sh; fi
trap 'rm -rf "$outside"' EXIT

rm -rf "$OUT/sdist" "$OUT/wheel"
"$PYTHON" -m build --no-isolation --sdist --outdir "$OUT/sdist" "$HERE"
tar -xzf "$OUT"/sdist/*.tar.gz -C "$outside" --strip-components=1

cd "$outside"
# The compiler that CMake would take, and sources where they are seen from build/PRESET of the
# checkout: so ccache knows what was compiled there, or in the folder before this.
CC=${CC:-cc} CXX=${CXX:-c++} CCACHE_DIR=${CCACHE_DIR:-$OUT/ccache} \
  CCACHE_BASEDIR=$outside/native CCACHE_NOHASHDIR=1 \
  "$PYTHON" -m build --no-isolation --wheel --outdir "$outside/raw" \
  --config-setting=build-dir=native/build/wheel \
  --config-setting=cmake.define.CMAKE_CXX_COMPILER_LAUNCHER="$launcher" \
  --config-setting=cmake.define.BELTRAMI_WERROR=ON \
  --config-setting=cmake.define.BELTRAMI_OLD_GLIBC=ON .
PATH=$(dirname "$PYTHON"):$PATH "$PYTHON" -m auditwheel repair --plat manylinux_2_28_x86_64 \
  --wheel-dir "$OUT/wheel" raw/*.whl
