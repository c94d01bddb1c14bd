# SPDX-License-Identifier: GPL-3.0-or-later
"""From meshes and options to solved charts, in a thread."""
