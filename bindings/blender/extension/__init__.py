# SPDX-FileCopyrightText: 2026 The beltrami authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension of Blender: unwraps, packs and checks UVs with beltrami."""

from . import following, operators, panels, properties, running


def register() -> None:
    """Register all there is."""
    properties.register()
    operators.register()
    panels.register()


def unregister() -> None:
    """Take all of it back."""
    running.unregister()
    following.unregister()
    panels.unregister()
    operators.unregister()
    properties.unregister()
