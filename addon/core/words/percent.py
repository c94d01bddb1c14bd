# SPDX-License-Identifier: GPL-3.0-or-later
"""Angle distortion as artists read and type it: by how many percent angles are off."""


def percent_of_qc(qc: float) -> float:
    """Return by how many percent angles are off, given the quasi-conformal distortion; rounding may take it below 1."""
    return max(100.0 * (qc - 1.0), 0.0)


def qc_of_percent(percent: float) -> float:
    """Return the quasi-conformal distortion where angles are off by this percentage."""
    return 1.0 + percent / 100.0
