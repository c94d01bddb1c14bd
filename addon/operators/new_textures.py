# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that makes a new UV map and draws the textures for it."""

import time
from dataclasses import replace
from functools import partial

import bpy

from .. import names
from ..core.words import texts
from ..core.words.translation import translate
from ..edit_mesh.textures import Drawn
from ..unwrapping import new_textures, steps
from ..unwrapping.last_settings import settings_for
from .job_operator import Job, JobOperator
from .property_kinds import choice
from .unwrap_properties import PackingProperties


class UV_OT_spectral_new_textures(PackingProperties, JobOperator, bpy.types.Operator):
    """Make a new UV map of the edited or selected meshes, and draw their image textures for it."""

    bl_idname = names.NEW_TEXTURES_OPERATOR
    bl_label = texts.NEW_TEXTURES_LABEL
    bl_description = (
        "Unwrap whole meshes to a new UV map, and draw every image texture that reads the active "
        "map anew for it, so that all looks the same. The old map and images stay. Without "
        "marked seams, islands end where those of the active map do"
    )
    # Adds its step of undo itself, which brings back images and materials also in edit mode.
    bl_options = {"REGISTER"}
    modes = frozenset({"EDIT_MESH", "OBJECT"})

    size: choice(
        "New Textures",
        "The size of the new textures",
        (
            ("SAME", "As Before", "Each texture keeps its size"),
            ("SIZE", "Texture Size", "The texture size of the scene"),
            ("AUTO", "No Loss", "The texture size of the scene, doubled until no detail is lost"),
        ),
    )

    def job(self, context: bpy.types.Context, is_interactive: bool) -> Job:
        """Read, unwrap, draw one texture after the other, and write all; report the outcome."""
        start = time.perf_counter()
        # A square texture of the panel needs no correction.
        is_same = self.size == "SAME"
        if not is_same:
            self.texture_size = self.texture_size or getattr(context.scene, names.TEXTURE_SIZE_PROPERTY)
        margin, side = self.pixels(context)
        last = settings_for(self)
        settings = replace(
            last,
            keep_in_place=False,
            blend=(1.0, 1.0),
            margin=margin / side,
            rotation=self.turns(context),
            correct_aspect=last.correct_aspect and is_same,
        )
        found = new_textures.read(context, settings)
        if not found.edit_meshes:
            return self.without_map(context)
        done = yield partial(steps.solve_and_place, found.edit_meshes, settings)
        solved, is_late = done.result, done.is_late
        if not any(solution.solved_corners.any() for solution in solved.solutions):
            return self.canceled(new_textures.failures(found, solved))
        size = new_textures.size(self.size, round(side))
        every = [each.polygons.selected_faces for each in found.edit_meshes]
        drawn, losses = [], []
        for job in found.textures.jobs:
            if is_late and not found.is_unchanged():
                return self.canceled(translate(texts.MESHES_CHANGED_NO_TEXTURES))
            pixels, changes = job.pixels(), job.changes(found.textures.meshes, solved.placement.uv, every)
            done = yield partial(job.draw, pixels, changes, size)
            is_late |= done.is_late
            baked, loss = done.result
            if baked is not None:
                drawn.append(Drawn(job, baked.image))
                losses.append(loss)
        if is_late and not found.is_unchanged():
            return self.canceled(translate(texts.MESHES_CHANGED_NO_TEXTURES))
        self.report_all(new_textures.finish(found, solved, drawn, losses, time.perf_counter() - start))
        return {"FINISHED"}
