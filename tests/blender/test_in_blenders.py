# SPDX-License-Identifier: GPL-3.0-or-later
"""Every file of `inside`, in every Blender, each in a process of its own."""

import subprocess
from pathlib import Path

import blenders
import pytest

INSIDE = Path(__file__).with_name("inside")


@pytest.mark.parametrize("blender", blenders.all_blenders(), ids=lambda blender: blender.name)
@pytest.mark.parametrize("file", sorted(INSIDE.glob("test_*.py")), ids=lambda file: file.stem)
def test_in_blender(blender, file, tmp_path):
    if blender.name == "system":
        blenders.system_blender()
    options = ["-q", "--tb=short", "-p", "no:cacheprovider", f"--confcutdir={INSIDE}", f"--rootdir={INSIDE}"]
    result = subprocess.run(
        [*blender.pytest_command, *options, "--color=no", str(file)],
        env=blenders.make_profile(tmp_path, blender.bundles_module),
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=600,
    )
    if result.returncode != 0:
        pytest.fail(f"{file.name} in {blender.name}, exit code {result.returncode}:\n{result.stdout}", pytrace=False)
    assert " passed" in result.stdout
    assert " skipped" not in result.stdout
