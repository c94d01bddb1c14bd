# SPDX-License-Identifier: GPL-3.0-or-later
"""The batch as a command of Blender's: `blender --command spectral_unwrap INPUTS... --out DIR`, from 4.2 on."""

from __future__ import annotations

import bpy

from .. import names

_registered: list[object] = []


def _run(arguments: list[str]) -> int:
    from . import command

    return command.main(arguments)


def register() -> None:
    """Add the command to a Blender that has such."""
    if hasattr(bpy.utils, "register_cli_command"):
        _registered.append(bpy.utils.register_cli_command(names.COMMAND, _run))


def unregister() -> None:
    """Remove it."""
    while _registered:
        bpy.utils.unregister_cli_command(_registered.pop())
