# SPDX-License-Identifier: GPL-3.0-or-later
"""What an artist sees and clicks outside the viewports: menus, panels, progress."""
