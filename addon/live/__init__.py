# SPDX-License-Identifier: GPL-3.0-or-later
"""Live Spectral Unwrap: the map follows moved pins and changed seams, constraints and extenders."""
