# SPDX-License-Identifier: GPL-3.0-or-later
"""Straight edges, rectangles, grids and symmetry: from marked edges to equations for the solver."""
