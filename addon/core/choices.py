# SPDX-License-Identifier: GPL-3.0-or-later
"""Identifiers of the choices of an artist; words/texts.py has their labels."""

# What the overlay shows of a map.
LOOK_ANGLE = "ANGLE"
LOOK_SIZE = "SIZE"
LOOK_DENSITY = "DENSITY"
LOOK_DEFECTS = "DEFECTS"
LOOK_CHECKER = "CHECKER"
LOOK_STACKS = "STACKS"

# Where unwrapped islands go.
PACK = "PACK"
KEEP = "KEEP"
