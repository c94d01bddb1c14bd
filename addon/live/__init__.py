# SPDX-License-Identifier: GPL-3.0-or-later
"""Live Spectral Unwrap: the map follows moved pins, seams that are marked or cleared, and changed extenders."""
