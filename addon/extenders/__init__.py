# SPDX-License-Identifier: GPL-3.0-or-later
"""The extenders of a mesh: how they are stored, followed through edits, and their strength as a property."""
