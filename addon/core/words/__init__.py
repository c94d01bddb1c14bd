# SPDX-License-Identifier: GPL-3.0-or-later
"""What artists read: every sentence, and its language."""
