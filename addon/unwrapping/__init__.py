# SPDX-License-Identifier: GPL-3.0-or-later
"""An unwrap from its settings to its outcome: read, solve, place, write, report."""
