# SPDX-License-Identifier: GPL-3.0-or-later
"""One unwrap from its settings to its outcome: read, solve, place, write, pack."""
