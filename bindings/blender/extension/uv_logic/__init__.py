# SPDX-FileCopyrightText: 2026 The beltrami authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the extension does to meshes, as functions of arrays: nothing here needs Blender."""
