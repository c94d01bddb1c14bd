# SPDX-License-Identifier: GPL-3.0-or-later
"""Identifiers of the artist's choices; their labels stand beside the properties, or in words/texts.py."""

# What the overlay shows of a map.
LOOK_ANGLE = "ANGLE"
LOOK_SIZE = "SIZE"
LOOK_DENSITY = "DENSITY"
LOOK_DEFECTS = "DEFECTS"
LOOK_CHECKER = "CHECKER"
LOOK_STACKS = "STACKS"

# How packing treats islands that lie on each other.
STACKS_APART = "APART"
STACKS_KEPT = "KEPT"
STACKS_OVERLAPPING = "OVERLAPPING"
STACKS_EQUAL = "EQUAL"
STACKS_MIRRORED = "MIRRORED"

# What packing fills.
TILES_OWN = "OWN"
TILES_ACTIVE = "ACTIVE"
TILES_SEVERAL = "SEVERAL"
TILES_AUTO = "AUTO"
TILES_BOUNDS = "BOUNDS"
TILES_BOX = "BOX"

# What Select looks for.
SELECT_DISTORTED = "DISTORTED"
SELECT_STRETCHED = "STRETCHED"
SELECT_DEFECTS = "DEFECTS"
SELECT_FLIPPED = "FLIPPED"
SELECT_OVERLAPPING = "OVERLAPPING"
SELECT_FAILED = "FAILED"

# The style of seams at sharp angles; the others are those of the module.
SEAMS_BY_ANGLE = "ANGLE"

# What Texel Density does.
DENSITY_NUMBER = "NUMBER"
DENSITY_EQUAL = "EQUAL"
DENSITY_FACTOR = "FACTOR"
DENSITY_PICKED = "PICK"

# Shapes of the map.
SHAPE_STRAIGHT = "STRAIGHT"
SHAPE_RECTANGLE = "RECTANGLE"
SHAPE_GRID = "GRID"
SHAPE_SYMMETRIC = "SYMMETRIC"
SHAPE_UPRIGHT = "UPRIGHT"
SHAPE_EXTENDER = "EXTENDER"

# Defaults, those of `spectral_conformal.defaults`, which has the reasons (tests/core/test_defaults.py).
MARGIN = 4.0
TEXTURE_SIZE = 1024
ROTATION = "SQUARE"
