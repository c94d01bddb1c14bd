# SPDX-License-Identifier: GPL-3.0-or-later
"""The manual in the packages: the guide and all documents that it links to, as plain pages.

Blender's "Online Manual" of an operator or a setting opens it from disk, without a server. `files` runs this as
`python -m tools.manual FOLDER` in build/venv, which has Markdown.
"""

from __future__ import annotations

import re
import sys
import tempfile
from pathlib import Path

from tools import steps
from tools.environment import PYTHON
from tools.steps import ROOT

DOCUMENTS = ROOT / "docs"
FIRST = "guide.md"
_LINK = re.compile(r"(!?\[[^\]]*\])\(([^)#\s]*)(#[^)\s]*)?\)")
_PAGE = """<!DOCTYPE html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>{title}</title>
<style>
body {{ max-width: 46em; margin: 2em auto; padding: 0 1em; font-family: sans-serif; line-height: 1.5; }}
img {{ max-width: 100%; }}
table {{ border-collapse: collapse; display: block; overflow-x: auto; }}
td, th {{ border: 1px solid #999; padding: 0.2em 0.6em; text-align: left; }}
pre {{ overflow-x: auto; padding: 0.6em; border: 1px solid #999; }}
</style>
{body}
</html>
"""


def files() -> dict[str, bytes]:
    """Return the pages and their pictures by path in the manual; raise StepError for a broken link."""
    with tempfile.TemporaryDirectory() as folder:
        steps.run_quietly("making the manual", [PYTHON, "-m", "tools.manual", folder], log="package")
        made = Path(folder)
        return {
            path.relative_to(made).as_posix(): path.read_bytes() for path in sorted(made.rglob("*")) if path.is_file()
        }


def _write(folder: Path) -> None:
    """Write the first document and all documents that can be reached from it."""
    import markdown  # in build/venv only

    waiting, known = [FIRST], {FIRST}
    while waiting:
        name = waiting.pop()
        source = DOCUMENTS / name

        def lead(match: re.Match, source: Path = source) -> str:
            text, target, place = match[1], match[2], match[3] or ""
            if not target or "://" in target:
                return match[0]
            path = (source.parent / target).resolve()
            if not path.is_file() or DOCUMENTS not in path.parents:
                raise SystemExit(f"{source.name} links to {target}, which is not a file in docs/.")
            relative = path.relative_to(DOCUMENTS).as_posix()
            if relative not in known:
                known.add(relative)
                if path.suffix == ".md":
                    waiting.append(relative)
                else:
                    written = folder / relative
                    written.parent.mkdir(parents=True, exist_ok=True)
                    written.write_bytes(path.read_bytes())
            return f"{text}({re.sub(r'[.]md$', '.html', relative)}{place})"

        text = _LINK.sub(lead, source.read_text(encoding="utf-8"))
        body = markdown.markdown(text, extensions=["tables", "fenced_code", "toc"])
        title = re.search(r"^# (.+)$", text, re.MULTILINE)[1]
        page = _PAGE.format(title=title, body=body)
        (folder / name).with_suffix(".html").write_text(page, encoding="utf-8")


if __name__ == "__main__":
    _write(Path(sys.argv[1]))
