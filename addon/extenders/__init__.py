# SPDX-License-Identifier: GPL-3.0-or-later
"""The extenders of a mesh: stored with it, and found again after edits and undo."""
