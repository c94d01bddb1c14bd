# SPDX-License-Identifier: GPL-3.0-or-later
"""The part of the add-on without Blender: NumPy arrays in, NumPy arrays and sentences out."""
