# SPDX-License-Identifier: GPL-3.0-or-later
"""Packages for every system that Blender runs on, made on one x86-64 Debian; everything goes under build/cross/."""
