# SPDX-License-Identifier: GPL-3.0-or-later
"""An unwrap that solves in a thread while Blender goes on."""

import time
from contextlib import nullcontext

import bpy

from ..core.options import Settings
from ..core.solve import Solution
from ..core.worker import Worker
from ..edit_mesh.read import EditMesh
from . import steps
from .steps import Outcome, WhileWriting


class UnwrapInThread:
    """Solves in a thread, from construction on; everything else runs in the thread that calls it.

    Attributes:
        worker: the solve.
    """

    def __init__(self, settings: Settings, edit_meshes: list[EditMesh]) -> None:
        """Start to solve the meshes that `unwrap.read` returned."""
        self._start = time.perf_counter()
        self._settings = settings
        self._edit_meshes = edit_meshes
        self.worker: Worker[list[Solution]] = Worker(lambda progress: steps.solve(edit_meshes, settings, progress))

    @property
    def seconds(self) -> float:
        """Time since construction."""
        return time.perf_counter() - self._start

    def is_current(self, context: bpy.types.Context) -> bool:
        """Return whether the meshes are still in edit mode and what they were; ask before `write` after a delay."""
        edit_meshes = steps.read_again(context, self._settings, self._edit_meshes)
        if edit_meshes is None:
            return False
        self._edit_meshes = edit_meshes
        return True

    def write(self, context: bpy.types.Context, while_writing: WhileWriting = nullcontext) -> Outcome:
        """Wait for the solve, place and write its result.

        Raises:
            NativeModuleError: `spectral_conformal` cannot be imported.
            PackingError: Blender's packer did not run; nothing changed.
        """
        return steps.write(context, self._settings, self._edit_meshes, self.worker.result(), while_writing)
