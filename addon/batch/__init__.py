# SPDX-License-Identifier: GPL-3.0-or-later
"""Unwrap many files from the command line. The only part of the add-on that reaches files and processes."""
