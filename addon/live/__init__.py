# SPDX-License-Identifier: GPL-3.0-or-later
"""Live Spectral Unwrap: the map follows while pins are moved, after seams are marked or cleared, and extenders."""
