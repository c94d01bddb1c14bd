# SPDX-License-Identifier: GPL-3.0-or-later
"""The site of the documents: it builds without a warning, is complete, leads nowhere else and needs no network."""

import re
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest
import spectral_conformal

from tools.site import command

# Attributes by which a page loads something; links of <a> are only followed by readers.
LOADING = ("src", "srcset", "poster", "data")


class Page(HTMLParser):
    """The ids of a page, where its links lead and what it loads."""

    def __init__(self, path):
        super().__init__()
        self.ids, self.links, self.loads = set(), [], []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attrs):
        for name, value in attrs:
            if name == "id":
                self.ids.add(value)
            elif name == "href" and tag == "a":
                self.links.append(value)
            elif name in LOADING or (name == "href" and tag == "link"):
                self.loads.append(value)


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    folder = tmp_path_factory.mktemp("site")
    command.build(folder)
    return folder


@pytest.fixture(scope="module")
def pages(site):
    return {path: Page(path) for path in site.rglob("*.html")}


def test_every_document_is_a_page(site):
    documents = {path.stem for path in (Path(command.ROOT) / "docs").glob("*.md")}
    assert {path.stem for path in site.glob("*.html")} == {*documents, "index", "404"}


def test_the_reference_has_every_public_name(pages, site):
    ids = pages[site / "api.html"].ids
    assert [name for name in spectral_conformal.__all__ if f"spectral_conformal.{name}" not in ids] == []


def test_the_reference_has_docstrings_and_fields(pages, site):
    text = (site / "api.html").read_text(encoding="utf-8")
    assert "Map one disk-like patch (holes allowed) conformally to the plane." in text
    assert {"spectral_conformal.Chart.n_pins", "spectral_conformal.Solver.solve"} <= pages[site / "api.html"].ids
    assert 'href="#spectral_conformal.Cancelled"' in text


def dead_links(pages, site):
    for path, page in pages.items():
        # Of any folder, so with absolute paths.
        for link in page.links if path.name != "404.html" else ():
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            found = target.is_file() and target.is_relative_to(site)
            if found and parts.fragment and target in pages:
                found = unquote(parts.fragment) in pages[target].ids
            if not found:
                yield path.name, link


def test_links_and_anchors_lead_somewhere(pages, site):
    assert sum(len(page.links) for page in pages.values()) > 200
    assert list(dead_links(pages, site)) == []


def test_what_f1_opens_is_there(pages):
    ids = next(page.ids for path, page in pages.items() if path.name == "guide.html")
    manual = (Path(command.ROOT) / "addon" / "manual.py").read_text(encoding="utf-8")
    opened = re.findall(r'"guide\.html#([^"]+)"', manual)
    assert len(opened) > 5
    assert set(opened) <= set(ids)


def test_a_dead_link_is_seen(tmp_path):
    page = tmp_path / "page.html"
    page.write_text('<h1 id="there"></h1><a href="#there"></a><a href="#gone"></a><a href="gone.html"></a>')
    assert list(dead_links({page: Page(page)}, tmp_path)) == [("page.html", "#gone"), ("page.html", "gone.html")]


def test_nothing_is_loaded_from_the_network(pages, site):
    assert [url for page in pages.values() for url in page.loads if urlsplit(url).netloc] == []
    for sheet in site.rglob("*.css"):
        urls = re.findall(r"(?:@import|url\()\s*['\"]?([^'\")\s]+)", sheet.read_text(encoding="utf-8"))
        assert [url for url in urls if urlsplit(url).netloc] == [], sheet


def test_what_a_page_loads_is_there(pages):
    for path, page in pages.items():
        if path.name == "404.html":
            continue
        for url in page.loads:
            assert (path.parent / unquote(urlsplit(url).path)).is_file(), f"{path.name}: {url}"
