# SPDX-License-Identifier: GPL-3.0-or-later
"""Pairs of vertices that are pushed apart or pulled together."""
