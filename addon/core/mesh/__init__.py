# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh as arrays: the record, its charts, several joined to one."""
