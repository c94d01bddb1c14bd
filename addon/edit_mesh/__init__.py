# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes in edit mode: to arrays, back to UVs, their selection, Blender's packer."""
