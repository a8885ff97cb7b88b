#!/usr/bin/env bash
# Tests the Rust crates beside a library that CMake has built, with its program:
#   bindings/rust/test.sh BUILD_FOLDER [all|short|--write]
# short are the tests and one program with the crates. With --write it tests nothing, but writes anew what is
# generated from the header and the options.
set -euo pipefail
BUILD=$(realpath "$1")
cd "$(dirname "${BASH_SOURCE[0]}")"
ROOT=$(realpath ../..)
readonly BUILD ROOT TARGET=$ROOT/build/rust
readonly PLACE=$TARGET/tests PACKAGES=$TARGET/packages MESH=$ROOT/examples/data/nefertiti_disk.obj
readonly CLOSED=$ROOT/examples/data/spot.obj
export CARGO_TERM_COLOR=never RUSTDOCFLAGS='-D warnings'

fail() {
  echo "test.sh: $*" >&2
  exit 1
}

say() { echo "rust: $*"; }

# Runs a command with the library of CMake, shared.
with_library() (
  export BELTRAMI_LIB_DIR=$BUILD/src BELTRAMI_INCLUDE_DIR=$ROOT/include LD_LIBRARY_PATH=$BUILD/src
  "$@"
)

unit_tests() {
  say "tests and documentation tests"
  with_library cargo test --locked --quiet --workspace --features beltrami/mint,beltrami/ndarray
}

# What is generated from the header and the option table is what is committed.
generated_sources() {
  say "generated sources"
  with_library cargo test --locked --quiet -p beltrami-sys --features buildtime-bindgen \
    --test bindings
  with_library cargo test --locked --quiet -p beltrami --test option_table
}

# The library's reads and writes of the caller's memory, as valgrind sees them.
memory() {
  say "memory, by valgrind"
  local runner="'valgrind', '--quiet', '--error-exitcode=9', '--leak-check=full'"
  runner+=", '--show-leak-kinds=definite,indirect', '--errors-for-leak-kinds=definite,indirect'"
  # Not the test that needs a scaffold, whose predicates never end: valgrind computes in
  # round-to-nearest whatever mode is set.
  with_library cargo test --locked --quiet -p beltrami \
    --config "target.'cfg(all())'.runner=[$runner]" \
    --test views --test flattening --test unwrapping --test control -- \
    --test-threads=1 --skip a_map_that_is_not_injective --skip an_atlas_that_is_not_injective
}

# The views, where the pointers of the safe layer are made. Miri cannot call C.
views_by_miri() {
  if ! cargo +nightly miri --version >/dev/null 2>&1; then
    say "no nightly toolchain with Miri here: the views go without it"
    return
  fi
  say "views, by Miri"
  DOCS_RS=1 cargo +nightly miri test --locked --quiet -p beltrami --target-dir "$TARGET/miri" \
    --test views
}

examples() {
  say "examples"
  local folder=$TARGET/debug/examples
  with_library cargo build --locked --quiet -p beltrami --examples
  with_library "$folder/flatten_obj" "$MESH" "$PLACE/flattened.obj" 2>/dev/null
  "$BUILD/program/beltrami" check "$PLACE/flattened.obj" >/dev/null
  # On a fast machine its run may be over before its user gives up.
  with_library "$folder/cancel" | tail -n 1 | tee "$PLACE/cancel.txt"
  grep -q -e '^cancelled' -e "faster than the user's patience" "$PLACE/cancel.txt"
  with_library "$folder/unwrap_obj" "$CLOSED" "$PLACE/unwrapped.obj" >/dev/null 2>&1
  "$BUILD/program/beltrami" check "$PLACE/unwrapped.obj" >/dev/null
  with_library "$folder/with_rayon" "$MESH" "$CLOSED" >"$PLACE/with_rayon.txt"
  grep -q '2 of 2 meshes are injective, and the loops of a run have the same bits' "$PLACE/with_rayon.txt"
  with_library "$folder/bake" "$MESH" "$PLACE/distortion.png"
  file "$PLACE/distortion.png" | grep -q 'PNG image data, 1024 x 1024'
}

# Documentation as docs.rs makes it: no network, no library, nothing compiled but Rust.
documentation() {
  say "documentation"
  DOCS_RS=1 cargo doc --locked --offline --quiet --no-deps --target-dir "$TARGET/docs-rs" \
    --features beltrami/mint,beltrami/ndarray
}

# Leaves the packages unpacked in $PACKAGES. Their files have old dates, by which cargo does not see
# a change; so what was built from others goes.
package() {
  say "packages"
  local new=$PLACE/new part
  cargo package --locked --quiet --workspace --no-verify --allow-dirty \
    --target-dir "$TARGET" 2>"$PLACE/package.log" || { cat "$PLACE/package.log" >&2; return 1; }
  mkdir "$new"
  for crate in "$TARGET"/package/*.crate; do tar -xzf "$crate" -C "$new"; done
  if grep -rlF "$ROOT" "$new"; then fail "these name folders of this machine"; fi
  for part in src include; do
    diff -r "$ROOT/$part" "$new"/beltrami-sys-*/vendor/"$part" || fail "packaged is another $part/"
  done
  if ! diff -rq --exclude=.cargo_vcs_info.json "$new" "$PACKAGES" >/dev/null 2>&1; then
    rm -rf "$PACKAGES" "$TARGET"/consumer-*
    mv "$new" "$PACKAGES"
  fi
}

# build_consumer NAME CARGO_ARGS...: builds the consumer in a folder of that name. The environment
# says what it links.
build_consumer() {
  cargo build --offline --quiet --manifest-path "$PLACE/consumer/Cargo.toml" \
    --target-dir "$TARGET/consumer-$1" "${@:2}"
}

# consumer NAME CARGO_ARGS...: builds it, and compares its UVs with those of the program, bit by bit.
consumer() {
  build_consumer "$@"
  "$TARGET/consumer-$1/debug/consumer" "$MESH" "$PLACE/reference.obj"
}

links_the_shared_library() {
  readelf -d "$TARGET/consumer-$1/debug/consumer" | grep -q 'NEEDED.*libbeltrami'
}

# Runs a command with the library that was installed.
with_installed() (
  PKG_CONFIG_PATH=$(dirname "$(find "$PLACE/prefix" -name beltrami.pc)")
  LD_LIBRARY_PATH=$(dirname "$PKG_CONFIG_PATH")
  export PKG_CONFIG_PATH LD_LIBRARY_PATH
  "$@"
)

# A program that has the packages and the library that CMake has built, and nothing else.
one_consumer() {
  cp -r tests/consumer "$PLACE"
  "$BUILD/program/beltrami" flatten "$MESH" "$PLACE/reference.obj" >/dev/null
  say "a program with the packages: BELTRAMI_LIB_DIR, shared"
  with_library consumer shared
  links_the_shared_library shared || fail "it is not the shared library"
}

# Every other way to the library.
consumers() {
  say "a program with the packages: BELTRAMI_LIB_DIR, static"
  BELTRAMI_STATIC=1 with_library consumer static
  if links_the_shared_library static; then fail "it is not the static library"; fi

  say "a program with the packages: BELTRAMI_LIB_DIR, the feature static"
  with_library consumer static-feature --features static
  if links_the_shared_library static-feature; then fail "it is not the static library"; fi

  say "a program with the packages: pkg-config, shared"
  rm -rf "$TARGET"/consumer-installed-* # cargo does not see that what is installed has changed
  cmake --install "$BUILD" --prefix "$PLACE/prefix" >/dev/null
  with_installed consumer installed-shared
  links_the_shared_library installed-shared || fail "it is not the shared library"

  say "a program with the packages: pkg-config, static"
  BELTRAMI_STATIC=1 with_installed consumer installed-static
  if links_the_shared_library installed-static; then fail "it is not the static library"; fi

  say "a program with the packages: vendored"
  consumer vendored --features vendored
  if links_the_shared_library vendored; then fail "it is not the static library"; fi

  say "a program with the packages: no library"
  if BELTRAMI_LIB_DIR=$PLACE/nowhere consumer nowhere 2>"$PLACE/nowhere.log"; then
    fail "it was linked with nothing"
  fi
  grep -q 'Choose one of' "$PLACE/nowhere.log"
}

# The features with another solver, whose UVs have other bits.
solvers() {
  local feature
  for feature in cholmod supernodal; do
    say "a program with the packages: $feature"
    build_consumer "$feature" --features "$feature"
    "$TARGET/consumer-$feature/debug/consumer" "$MESH" | tee "$PLACE/$feature.txt"
  done
  grep -q 'solver cholmod-simplicial,.*no GPL code' "$PLACE/cholmod.txt"
  grep -q 'solver cholmod,.*links GPL code' "$PLACE/supernodal.txt"
}

if [[ ${2:-} == --write ]]; then
  # Again, if it has changed the table that its other tests were compiled with.
  BELTRAMI_WRITE=1 generated_sources >/dev/null 2>&1 || BELTRAMI_WRITE=1 generated_sources
  exit
fi
rm -rf "$PLACE"
mkdir -p "$PLACE"
cargo fetch --locked --quiet # from here on nothing needs the network
unit_tests
generated_sources
if [[ ${2:-all} == all ]]; then
  memory
  views_by_miri
  examples
  documentation
fi
package
one_consumer
if [[ ${2:-all} == all ]]; then
  consumers
  solvers
fi
say "all tests passed"
