# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes in edit mode: read to arrays, write UVs and attributes, select."""
