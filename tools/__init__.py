# SPDX-License-Identifier: GPL-3.0-or-later
"""The work behind build_addon.py."""
