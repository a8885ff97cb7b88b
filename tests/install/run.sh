#!/usr/bin/env bash
# Installs, and uses what was installed as another project would: in folders made for it.
#   run.sh STEP BUILD_FOLDER SOURCE_FOLDER CC
set -euo pipefail
readonly STEP=$1 BUILD=$2 SOURCE=$3 CC=$4
readonly HERE=$SOURCE/tests/install PLACE=$BUILD/tests/install
readonly PREFIX=$PLACE/prefix WORK=$PLACE/$STEP
rm -rf "$WORK"
mkdir -p "$WORK"
cd "$WORK"

# Builds the consumer against the package under $1 as target $2 and runs it.
find_package() {
  cmake -S "$HERE/consumer" -B "$WORK/build" -G Ninja -DCMAKE_C_COMPILER="$CC" \
    -DCMAKE_PREFIX_PATH="$1" -DTARGET_NAME="$2" --log-level=WARNING >/dev/null
  cmake --build "$WORK/build" >/dev/null
  "$WORK/build/consumer"
}

fail() {
  echo "run.sh $STEP: $*" >&2
  exit 1
}

links_the_shared_library() { readelf -d "$1" | grep -q 'NEEDED.*libbeltrami'; }

# Prints the flags of pkg-config for the prefix $1, with further options.
flags() {
  local folder
  folder=$(dirname "$(find "$1" -name beltrami.pc)")
  PKG_CONFIG_PATH=$folder pkg-config --cflags --libs "${@:2}" beltrami
}

# Compiles the consumer with flags.
compile() { "$CC" "$HERE/consumer.c" -o consumer "$@"; }

no_machine_path() {
  if grep -rlF -e "$BUILD" -e "$SOURCE" "$1"; then fail "these name folders of the build"; fi
}

packages() {
  cpack --config "$BUILD/CPackConfig.cmake" -B "$WORK" -G "$1" >cpack.log 2>&1 ||
    { cat cpack.log >&2; return 1; }
  rm -rf _CPack_Packages
}

case $STEP in
  install)
    rm -rf "$PREFIX"
    cmake --install "$BUILD" --prefix "$PREFIX" >/dev/null
    # The folder is moved afterwards, as people do.
    mv "$PREFIX" "$PREFIX.moved"
    mv "$PREFIX.moved" "$PREFIX"
    no_machine_path "$PREFIX"
    test -s "$PREFIX/share/doc/beltrami/LICENSE"
    test -s "$PREFIX/share/doc/beltrami/licenses/THIRD-PARTY.txt"
    grep -q '^\.TH BELTRAMI 1' "$PREFIX/share/man/man1/beltrami.1"
    grep -q '^complete .* beltrami$' "$PREFIX/share/bash-completion/completions/beltrami"
    grep -q '^#compdef beltrami' "$PREFIX/share/zsh/site-functions/_beltrami"
    grep -q '^complete -c beltrami' "$PREFIX/share/fish/vendor_completions.d/beltrami.fish"
    if readelf -S "$PREFIX"/lib*/libbeltrami.so | grep -q '\.debug_info'; then
      fail "the installed library has debug information"
    fi
    "$PREFIX/bin/beltrami" --version
    ;;
  find-package-shared)
    find_package "$PREFIX" beltrami::beltrami
    links_the_shared_library build/consumer || fail "it is not the shared library"
    ;;
  find-package-static)
    find_package "$PREFIX" beltrami::beltrami_static
    if links_the_shared_library build/consumer; then fail "it is not the static library"; fi
    ;;
  pkg-config-shared)
    # shellcheck disable=SC2046 # flags are words
    compile $(flags "$PREFIX") -Wl,-rpath,"$PREFIX/lib"
    ./consumer
    links_the_shared_library consumer || fail "it is not the shared library"
    # shellcheck disable=SC2046
    c++ -std=c++17 -Wall -Wextra -Wconversion -Wshadow -Werror "$HERE/consumer.cpp" -o consumer_cpp \
      $(flags "$PREFIX") -Wl,-rpath,"$PREFIX/lib"
    ./consumer_cpp
    ;;
  pkg-config-static)
    # By its file: with -static all else would have to be there as static libraries, too.
    # shellcheck disable=SC2046
    compile $(flags "$PREFIX" --static | sed 's/-lbeltrami/-l:libbeltrami.a/')
    ./consumer
    if links_the_shared_library consumer; then fail "it is not the static library"; fi
    ;;
  add-subdirectory-shared | add-subdirectory-static)
    shared=ON
    if [[ $STEP == *static ]]; then shared=OFF; fi
    cmake -S "$HERE/superproject" -B build -G Ninja -DCMAKE_C_COMPILER="$CC" \
      -DBELTRAMI_SOURCE="$SOURCE" -DBUILD_SHARED_LIBS=$shared \
      -DBELTRAMI_SOLVER="$(sed -n 's/^BELTRAMI_SOLVER:STRING=//p' "$BUILD/CMakeCache.txt")" \
      -DBELTRAMI_SIMPLIFIER="$(sed -n 's/^BELTRAMI_SIMPLIFIER:STRING=//p' "$BUILD/CMakeCache.txt")" \
      -DCMAKE_CXX_COMPILER_LAUNCHER="$HERE/reuse_object.sh" --log-level=WARNING >/dev/null
    # No build type is given: the library's is Release all the same.
    if ! grep -q -e '-O3 -DNDEBUG' <<<"$(ninja -C build -t commands beltrami_inner)"; then
      fail "the library of a project without a build type is not optimised"
    fi
    BELTRAMI_BUILT=$BUILD cmake --build build --target consumer consumer_cpp >/dev/null
    ./build/consumer
    ./build/consumer_cpp
    found=OFF
    if links_the_shared_library build/consumer; then found=ON; fi
    if [[ $found != "$shared" ]]; then fail "it is not the $STEP library"; fi
    ;;
  package-archive)
    packages TGZ
    mkdir unpacked
    tar -xzf ./*.tar.gz -C unpacked --strip-components=1
    no_machine_path unpacked
    find_package "$WORK/unpacked" beltrami::beltrami
    ;;
  package-deb)
    packages DEB
    for package in ./*.deb; do dpkg-deb -x "$package" unpacked; done
    dpkg-deb -f libbeltrami[0-9]*.deb Package Version Depends Section
    dpkg-deb -f libbeltrami[0-9]*.deb Depends | grep -q 'libstdc++6'
    dpkg-deb -f libbeltrami-dev*.deb Depends | grep -q 'libbeltrami[0-9]* (= '
    find_package "$WORK/unpacked/usr" beltrami::beltrami
    LD_LIBRARY_PATH=$(dirname "$(find unpacked -name 'libbeltrami.so.?')") \
      unpacked/usr/bin/beltrami --version
    ;;
  *)
    echo "run.sh: there is no step '$STEP'" >&2
    exit 2
    ;;
esac
