# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh as arrays, and its charts."""
