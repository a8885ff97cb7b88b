#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The beltrami authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs the operators in a window of Debian's Blender, on a display of its own, with events as a user makes
# them: progress, Esc, undo, redo. That Blender is 3.4: it loads the sources as an add-on, and window.py
# stands in for the two calls that it has under other names.
#   run.sh ZIP [PICTURE]
# ZIP is what ./dev blender builds. PICTURE gets what the window shows during a run.
# Needs Debian's packages blender and xvfb.
set -euo pipefail
ZIP=$(realpath "$1")
PICTURE=$(realpath --canonicalize-missing "${2:-/dev/null}")
HERE=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
readonly ZIP PICTURE HERE
for program in blender xvfb-run; do
  command -v "$program" >/dev/null || {
    echo "run.sh: install Debian's packages blender and xvfb" >&2
    exit 2
  }
done
folder=$(mktemp -d)
readonly folder
trap 'rm -rf "$folder"' EXIT
mkdir -p "$folder/scripts/addons/beltrami_uv" "$folder/packages"
python3 -m zipfile -e "$ZIP" "$folder/scripts/addons/beltrami_uv"
for wheel in "$folder"/scripts/addons/beltrami_uv/wheels/*.whl; do
  python3 -m zipfile -e "$wheel" "$folder/packages"
done
cd "$folder"
BLENDER_USER_SCRIPTS=$folder/scripts PYTHONPATH=$folder/packages BELTRAMI_PICTURE=$PICTURE LIBGL_ALWAYS_SOFTWARE=1 \
  timeout 300 xvfb-run --auto-servernum --server-args '-screen 0 1280x900x24' \
  blender --factory-startup --python-use-system-env --enable-event-simulate --no-window-focus \
  --python-exit-code 1 --python "$HERE/window.py"
