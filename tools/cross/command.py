# SPDX-License-Identifier: GPL-3.0-or-later
"""`build_addon.py package --platforms`: build the zips of every system from scratch."""

from __future__ import annotations

import platform
import tempfile
from collections.abc import Sequence
from pathlib import Path

from tools import environment, packaging, steps
from tools.cross import native, notes, parts, targets, wheels
from tools.steps import StepError


def run(names: Sequence[str]) -> int:
    """Make the wheels and the zips of these platforms; replace the zips of an earlier call."""
    chosen = targets.named(names)
    if platform.machine() != "x86_64":
        raise StepError(f"The compilers exist only for x86_64; this machine is {platform.machine()}.")
    environment.set_up("build", "bpy", "package", "cross", native=False)
    with steps.exclusive():
        parts.fetch(chosen)
        made = []
        for target in chosen:
            native.build(target)
            made += wheels.make(target)
    version = packaging.version()
    with tempfile.TemporaryDirectory() as folder:
        for wheel in made:
            Path(folder, wheel.name).symlink_to(wheel)
        texts = {target.name: notes.text(target, version) for target in chosen}
        return packaging.run_with_wheels(Path(folder), targets.PACKAGES, texts)


def made() -> list[targets.Target]:
    """Return the targets that have wheels in build/cross/wheels/."""
    return [target for target in targets.TARGETS if any(targets.WHEELS.glob(f"*-{target.tag}.whl"))]
