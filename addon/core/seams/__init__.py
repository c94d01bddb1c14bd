# SPDX-License-Identifier: GPL-3.0-or-later
"""Seams to suggest."""
