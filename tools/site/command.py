# SPDX-License-Identifier: GPL-3.0-or-later
"""Build the site of the documents with MkDocs; a broken link is an error."""

from __future__ import annotations

import os
from pathlib import Path

from tools import steps
from tools.environment import PYTHON
from tools.steps import BUILD, ROOT

SITE = BUILD / "site"


def run() -> int:
    """Write README.md, docs/ and the module's reference to build/site/."""
    build(SITE)
    print(f"- open {(SITE / 'index.html').relative_to(ROOT)}")
    return 0


def build(folder: Path) -> None:
    """Write the site to a new folder; raise StepError for a broken link or an unknown name."""
    command = [PYTHON, "-m", "mkdocs", "build", "--strict", "--clean"]
    paths = ["--config-file", ROOT / "mkdocs.yml", "--site-dir", folder]
    # Ruff is called by its name.
    search = f"{PYTHON.parent}:{os.environ['PATH']}"
    # Keep announcements of future MkDocs versions out of the log.
    steps.run("building the site", [*command, *paths], log="docs", environ={"PATH": search, "NO_MKDOCS_2_WARNING": "1"})
