# SPDX-License-Identifier: GPL-3.0-or-later
"""Shapes, colors and room on the screen, as arrays."""
