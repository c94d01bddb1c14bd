# SPDX-License-Identifier: GPL-3.0-or-later
"""The strength of an extender as a property, wherever it stands."""

from ..core.words import texts

# Of every soft constraint: bounds drags and scripts.
STRENGTH_LIMIT = 1e4
# Arguments of the property.
STRENGTH = {
    **texts.STRENGTH_PROPERTY,
    "default": 1.0,
    "min": -STRENGTH_LIMIT,
    "max": STRENGTH_LIMIT,
    "soft_min": -10.0,
    "soft_max": 10.0,
}
