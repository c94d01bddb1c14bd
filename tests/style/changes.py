# SPDX-License-Identifier: GPL-3.0-or-later
"""Which C++ files changed lately, for checks that take minutes for all of them."""

import re
import subprocess

# Some days of work: each file is checked in every run of this time, and all files by `test --all`.
COMMITS = 20


def git(root, *words):
    """Return the lines that git prints, None if it fails: no git, no repository or too short a history."""
    try:
        result = subprocess.run(["git", "-C", root, *words], capture_output=True, text=True, check=False)
    except FileNotFoundError:
        return None
    return None if result.returncode else result.stdout.splitlines()


def changed(root, sources, commits=COMMITS, *, by_headers=True):
    """Return those of `sources` that changed in so many commits or since.

    Also, unless told otherwise, those that include a header that did, directly. All sources, if git does not know what
    changed.
    """
    found = git(root, "diff", "--name-only", "--relative", f"HEAD~{commits}", "--")
    new = git(root, "ls-files", "--others", "--exclude-standard")
    if found is None or new is None:
        return list(sources)
    paths = {root / name for name in (*found, *new)}
    headers = {path.name for path in paths if path.suffix == ".h" and by_headers}
    return [path for path in sources if path in paths or headers & included(path)]


def included(path):
    """Return the names, without folders, of the headers that a file includes."""
    return set(re.findall(r'^#include "(?:.*/)?([^/"]+)"', path.read_text(encoding="utf-8"), re.MULTILINE))
