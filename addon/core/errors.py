# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors that artists read."""


class ReadableError(Exception):
    """An error whose message tells an artist what to do; not a programming error."""
