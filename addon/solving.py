# SPDX-License-Identifier: GPL-3.0-or-later
"""An unwrap that solves in a thread while Blender goes on."""

import time

import bpy

from . import edit_mode_unwrap
from .core.unwrapping import Solution
from .core.worker import Worker
from .edit_mode_unwrap import Outcome, Settings
from .mesh_io import EditMesh


class UnwrapInThread:
    """Solves in a thread, from construction on; everything else runs in the thread that calls it.

    Attributes:
        worker: the solve.
    """

    def __init__(self, settings: Settings, edit_meshes: list[EditMesh]) -> None:
        """Start to solve the meshes that `edit_mode_unwrap.read` returned."""
        self._start = time.perf_counter()
        self._settings = settings
        self._edit_meshes = edit_meshes
        self.worker: Worker[list[Solution]] = Worker(
            lambda progress: edit_mode_unwrap.solve(edit_meshes, settings, progress)
        )

    @property
    def seconds(self) -> float:
        """Time since construction."""
        return time.perf_counter() - self._start

    def is_current(self, context: bpy.types.Context) -> bool:
        """Return whether the meshes are still in edit mode and what they were; ask before `write` after a delay."""
        edit_meshes = edit_mode_unwrap.read_again(context, self._settings, self._edit_meshes)
        if edit_meshes is None:
            return False
        self._edit_meshes = edit_meshes
        return True

    def write(self, context: bpy.types.Context) -> Outcome:
        """Wait for the solve, place and write its result.

        Raises:
            NativeModuleError: `spectral_conformal` cannot be imported.
            PackingError: Blender's packer did not run; nothing changed.
        """
        return edit_mode_unwrap.write(context, self._settings, self._edit_meshes, self.worker.result())
