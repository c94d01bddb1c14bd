# SPDX-License-Identifier: GPL-3.0-or-later
"""The overview of a batch: its lines and tables; no file name becomes code."""

import csv
import html.parser
import json
import os
import sys
from dataclasses import fields

import pytest
from spectral_conformal.assets.report import MapReport
from spectral_conformal.batch import overview, report_file

NAMES = [
    *("chair{0}.obj", "=1+1.obj", "+1.obj", "-1.obj", "@sum.obj", "\tx.obj", "new\nline.obj", "cr\rx.obj", "a,b.obj"),
    *('d"q.obj', "<script>alert(1)</script>.obj", "<img src=x onerror=alert(1)>.obj", "ä€日本 😀.obj", "\u202ertl.obj"),
]


def report_of(name, message=None):
    failure = {"kind": "broken", "message": message} if message else None
    return {"name": name, "status": "failed" if message else "unwrapped", "failure": failure, "seconds": {"total": 1.0}}


class Tags(html.parser.HTMLParser):
    """The elements of a page, and its texts."""

    def __init__(self, page):
        super().__init__()
        self.tags, self.texts, self.links = [], [], []
        self.feed(page)

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        self.links += [value for name, value in attributes if name == "href"]
        assert not [name for name, _ in attributes if name.startswith("on")]

    def handle_data(self, data):
        self.texts.append(data)


def test_names_and_messages_are_no_code(tmp_path):
    plain = [report_of(f"{k}.obj", "no message") for k in range(len(NAMES))]
    overview.write(tmp_path, plain)
    expected = Tags((tmp_path / overview.PAGE).read_text(encoding="utf-8")).tags
    overview.write(tmp_path, [report_of(name, f"{name} is broken") for name in NAMES])
    page = Tags((tmp_path / overview.PAGE).read_text(encoding="utf-8"))
    assert page.tags == expected
    assert all(name.replace("\r", "\n") in "\n".join(page.texts).replace("\r", "\n") for name in NAMES)
    with (tmp_path / overview.CSV).open(newline="", encoding="utf-8") as table:
        rows = list(csv.DictReader(table))
    assert [row["name"].removeprefix("'") for row in rows] == NAMES
    assert not [cell for row in rows for cell in row.values() if cell[:1] in tuple("=+-@\t\r")]
    assert [row["name"] for row in json.loads((tmp_path / overview.JSON).read_text())["rows"]] == NAMES


def test_numbers_stay_numbers(tmp_path):
    report = {**report_of("a.obj"), "totals": {"qc_mean": -1.5}}
    overview.write(tmp_path, [report])
    with (tmp_path / overview.CSV).open(newline="") as table:
        assert next(csv.DictReader(table))["qc_mean"] == "-1.5"


def test_line_counts_one_island_and_several():
    totals = {"faces": 12, "islands": 1, "flips": 0, "qc_mean": 1.25}
    report = {**report_of("a.obj"), "totals": totals}
    assert overview.line(report) == "unwrapped: 12 faces, 1 island, mean QC 1.2500, 0 flips, 1.00 s"
    totals.update(islands=2, flips=1)
    assert overview.line(report) == "unwrapped: 12 faces, 2 islands, mean QC 1.2500, 1 flip, 1.00 s"


WHOLE = {
    **{"status": "unwrapped", "settings": {}, "source_digest": "", "output_digest": "", "seconds": {"total": 1.0}},
    "totals": {"failed": 0, **{field.name: 1 for field in fields(MapReport)}},
}


@pytest.mark.parametrize(
    "change",
    [
        {"status": "<b>"},
        {"status": "failed"},
        {"status": "failed", "failure": {"kind": "error", "message": ["a"]}},
        {"totals": [1]},
        {"totals": {**WHOLE["totals"], "faces": "<script>"}},
        {"totals": {"faces": 1}},
        {"seconds": None},
        {"seconds": {"total": "long"}},
    ],
)
def test_a_report_of_somebody_else_is_none(change, tmp_path):
    (tmp_path / "report.json").write_text(json.dumps({**WHOLE, **change}))
    assert report_file.read(tmp_path) is None
    (tmp_path / "report.json").write_text(json.dumps(WHOLE))
    assert report_file.read(tmp_path) == WHOLE


def test_what_is_no_number_is_not_in_a_column_of_numbers(tmp_path):
    odd = {**report_of("a.obj", "bad"), "peak_memory": "<b>much</b>", "attempts": {"a": 1}, "totals": [1, 2]}
    overview.write(tmp_path, [odd])
    (row,) = json.loads((tmp_path / overview.JSON).read_text())["rows"]
    assert row["peak_memory"] is None and row["attempts"] is None and row["faces"] is None


@pytest.mark.skipif(sys.platform != "linux", reason="names of files are text there")
def test_a_name_that_is_no_text_is_in_the_overview(tmp_path):
    name = os.fsdecode(b"b\xfcro.obj")
    (tmp_path / name).mkdir()
    (tmp_path / name / "report.json").write_text("{}")
    overview.write(tmp_path, [report_of(name)])
    page = Tags((tmp_path / overview.PAGE).read_text(encoding="utf-8"))
    assert "b%FCro.obj/report.json" in page.links and "b?ro.obj" in page.texts
    assert b"b\xfcro.obj" in (tmp_path / overview.CSV).read_bytes()
    assert json.loads((tmp_path / overview.JSON).read_text())["rows"][0]["name"] == name
