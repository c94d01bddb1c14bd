# SPDX-License-Identifier: GPL-3.0-or-later
"""The documents as a site of static pages."""
