# SPDX-License-Identifier: GPL-3.0-or-later
"""Walls with windows: their triangles beside those of Blender, and their maps."""
