# SPDX-License-Identifier: GPL-3.0-or-later
"""Leave the tests in `inside` to the pytest that runs within Blender (test_in_blenders.py)."""

collect_ignore = ["inside"]
