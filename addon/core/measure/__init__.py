# SPDX-License-Identifier: GPL-3.0-or-later
"""What is measured of a map, and totals of it."""
