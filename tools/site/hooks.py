# SPDX-License-Identifier: GPL-3.0-or-later
"""Hooks of MkDocs for the site: README.md becomes the first page, and names in docstrings become links."""

from __future__ import annotations

import re
from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page


def on_files(files: Files, *, config: MkDocsConfig) -> Files:
    """Add README.md as index.md, with its links relative to docs/."""
    readme = Path(config.config_file_path).with_name("README.md").read_text(encoding="utf-8")
    files.append(File.generated(config, "index.md", content=readme.replace("](docs/", "](")))
    return files


def on_page_content(html: str, *, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Link the names in code spans of the reference to their entries there."""
    if page.file.src_uri != "api.md":
        return html
    entries = set(re.findall(r'id="spectral_conformal\.([\w.]+)"', html))

    def linked(span: re.Match[str]) -> str:
        name = span[1]
        return f'<a href="#spectral_conformal.{name}"><code>{name}</code></a>' if name in entries else span[0]

    # The reference has no source for the names in the compiled part.
    compiled = r'<autoref identifier="spectral_conformal\._native[^>]*>'
    return re.sub(rf"<code>(?:{compiled})?([\w.]+)(?:</autoref>)?</code>", linked, html)
