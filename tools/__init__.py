"""The work behind build_addon.py."""
