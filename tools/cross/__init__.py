# SPDX-License-Identifier: GPL-3.0-or-later
"""Packages for every system that runs Blender, built on one x86-64 Debian; all output goes to build/cross/."""
