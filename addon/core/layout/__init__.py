# SPDX-License-Identifier: GPL-3.0-or-later
"""Where solved charts go in the UV plane."""
