"""The overview of a batch: a summary as JSON and CSV, and a page for browsing."""

from __future__ import annotations

import base64
import csv
import html
import io
import json
import os
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any
from urllib.parse import quote

from ..assets import drawing
from . import entries, report_file

JSON, CSV, PAGE = "summary.json", "summary.csv", "index.html"

# Name of the column, and its path in a report.
COLUMNS: tuple[tuple[str, tuple[str, ...]], ...] = (
    ("name", ("name",)),
    ("status", ("status",)),
    ("failure", ("failure", "kind")),
    ("faces", ("totals", "faces")),
    ("islands", ("totals", "islands")),
    ("failed_islands", ("totals", "failed")),
    ("qc_mean", ("totals", "qc_mean")),
    ("qc_p99", ("totals", "qc_p99")),
    ("qc_max", ("totals", "qc_max")),
    ("density_spread", ("totals", "density_spread")),
    ("fill", ("totals", "fill")),
    ("flips", ("totals", "flips")),
    ("overlaps", ("totals", "overlaps")),
    ("seam_length", ("totals", "seam_length")),
    ("seconds", ("seconds", "total")),
    ("peak_memory", ("peak_memory",)),
    ("attempts", ("attempts",)),
    ("message", ("failure", "message")),
    ("not_met", ("not_met",)),
    ("warnings", ("warnings",)),
)
# On the page, what is said of an asset is below its numbers, as wide as the table.
_SAID = {"message": "", "not_met": "required: ", "warnings": "warning: "}
# Characters that begin a formula in a spreadsheet; OWASP, "CSV Injection".
_FORMULA = ("=", "+", "-", "@", "\t", "\r")
_STYLE = """
body{font:14px system-ui,sans-serif;margin:1.5em;background:#fff;color:#222}
table{border-collapse:collapse}th,td{padding:.25em .4em;border-bottom:1px solid #ddd;text-align:right}
th{position:sticky;top:0;background:#eee;cursor:pointer}th[data-sorted=up]::after{content:" \\25B2"}
th[data-sorted=down]::after{content:" \\25BC"}td.text,th.text{text-align:left}
tr.failed td{background:#fdd}tr.incomplete td{background:#ffd}img{width:80px;height:80px;display:block}
.links{font-size:smaller}
td.name,.said td{overflow-wrap:anywhere;white-space:pre-line}td.name{min-width:11em}
.said td{border-top:none;text-align:left;padding-left:1.5em}tr:has(+.said) td{border-bottom:none}
"""
# Numbers by size, texts alphabetically; empty cells last. The messages of an asset stay in the row below it.
_SCRIPT = """
document.querySelectorAll("th").forEach((head, column) => head.addEventListener("click", () => {
  const body = document.querySelector("tbody"), down = head.dataset.sorted === "up";
  document.querySelectorAll("th").forEach(other => delete other.dataset.sorted);
  head.dataset.sorted = down ? "down" : "up";
  const key = row => row.cells[column].dataset.value ?? row.cells[column].textContent;
  const compare = (a, b) => a === "" || b === "" ? (a === "") - (b === "") :
    (down ? -1 : 1) * (isNaN(a) || isNaN(b) ? a.localeCompare(b) : a - b);
  const assets = [...body.rows].filter(row => !row.matches(".said")).map(row => [row, row.nextElementSibling]);
  assets.sort(([a], [b]) => compare(key(a), key(b))).forEach(
    ([row, next]) => body.append(row, ...(next?.matches(".said") ? [next] : [])));
}));
"""


def line(report: dict[str, Any]) -> str:
    """Return a one-line summary of an asset."""
    failure = report.get("failure")
    if failure:
        return f"{report['status']} ({failure['kind']}): {failure['message']}"
    totals, seconds = report["totals"], report["seconds"]["total"]
    mean = totals["qc_mean"]
    quality = "nothing mapped" if mean is None else f"mean QC {mean:.4f}, {_counted(totals['flips'], 'flip')}"
    missed = f"; required: {'; '.join(report['not_met'])}" if report.get("not_met") else ""
    counts = f"{_counted(totals['faces'], 'face')}, {_counted(totals['islands'], 'island')}"
    return f"{report['status']}: {counts}, {quality}, {seconds:.2f} s{missed}"


def _counted(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def row(report: dict[str, Any]) -> dict[str, Any]:
    """Return the columns of a report, None for values that are missing or of the wrong kind."""
    found = {name: _value(report, path) for name, path in COLUMNS}
    return {
        name: value if _kind(name) == "text" or report_file.is_number(value, or_none=True) else None
        for name, value in found.items()
    }


def _value(report: dict[str, Any], path: Sequence[str]) -> Any:  # noqa: ANN401 - any of JSON's
    value: Any = report
    for name in path:
        value = value.get(name) if isinstance(value, dict) else None
    if isinstance(value, list):
        return "; ".join(map(str, value))
    return str(value) if isinstance(value, dict) else value


def write(out: Path, reports: Sequence[dict[str, Any]], is_interrupted: bool = False) -> None:
    """Write the overview of all assets, in their order, into the folder of the results."""
    rows = [row(report) for report in reports]
    counts = Counter(report["status"] for report in reports)
    summary = {
        "assets": len(reports),
        "interrupted": is_interrupted,
        "status": dict(sorted(counts.items())),
        "failures": dict(sorted(Counter(found["failure"] for found in rows if found["failure"]).items())),
        "seconds": sum(found["seconds"] or 0.0 for found in rows),
        "rows": rows,
    }
    report_file.replace(out / JSON, json.dumps(summary, indent=1).encode())
    table = io.StringIO(newline="")
    writer = csv.DictWriter(table, [name for name, _ in COLUMNS])
    writer.writeheader()
    writer.writerows({name: _no_formula(value) for name, value in found.items()} for found in rows)
    # File names are bytes on Linux, and may not be valid text.
    report_file.replace(out / CSV, table.getvalue().encode(errors="surrogateescape"))
    report_file.replace(out / PAGE, _page(out, rows, counts).encode(errors="replace"))


def _no_formula(value: Any) -> Any:  # noqa: ANN401 - any of JSON's
    """Return a text that a spreadsheet would take for a formula with a quote before it, anything else unchanged."""
    return f"'{value}" if isinstance(value, str) and value.startswith(_FORMULA) else value


def _page(out: Path, rows: Sequence[dict[str, Any]], counts: Counter[str]) -> str:
    columns = [name for name in rows[0] if name not in _SAID]
    heads = "".join(f'<th class="{_kind(name)}">{_title(name)}</th>' for name in ("layout", *columns))
    body = "\n".join(
        f'<tr class="{html.escape(found["status"])}"><td>{_picture(out, found)}</td>'
        + "".join(_cell(name, found[name], _links(out, found) if name == "name" else "") for name in columns)
        + "</tr>"
        + _said(found, len(columns))
        for found in rows
    )
    statuses = ", ".join(f"{count} {status}" for status, count in sorted(counts.items()))
    return (
        '<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><title>Spectral Unwrap</title>'
        f"<style>{_STYLE}</style></head><body><h1>{len(rows)} assets: {statuses}</h1>"
        f"<table><thead><tr>{heads}</tr></thead><tbody>\n{body}\n</tbody></table>"
        f"<script>{_SCRIPT}</script></body></html>"
    )


def _kind(name: str) -> str:
    return "text" if name in ("name", "status", "failure", "message", "not_met", "warnings") else "number"


def _title(name: str) -> str:
    return name.replace("_", " ").replace("qc", "QC")


def _cell(name: str, value: Any, links: str) -> str:  # noqa: ANN401 - any of JSON's
    if value is None:
        shown = exact = ""
    elif name == "peak_memory":
        shown, exact = f"{value / 2**20:.0f} MiB", value
    else:
        shown, exact = f"{value:.4g}" if isinstance(value, float) else str(value), value
    return f'<td class="{_kind(name)} {name}" data-value="{html.escape(str(exact))}">{html.escape(shown)}{links}</td>'


def _said(found: dict[str, Any], n_columns: int) -> str:
    """Return the row of messages of an asset, empty if there are none."""
    lines = [f"{title}{found[name]}" for name, title in _SAID.items() if found[name]]
    if not lines:
        return ""
    text = html.escape("\n".join(lines))
    return f'<tr class="said {html.escape(found["status"])}"><td></td><td colspan="{n_columns}">{text}</td></tr>'


def _links(out: Path, found: dict[str, Any]) -> str:
    """Return links to the existing files of an asset besides the layout."""
    folder = out / found["name"]
    there = {"report": folder / entries.REPORT, "checker": folder / entries.CHECKER}
    there.update({suffix[1:].upper(): folder / f"{entries.PATTERN}{suffix}" for suffix in drawing.FORMATS})
    links = [f'<a href="{_relative(path, out)}">{name}</a>' for name, path in there.items() if path.exists()]
    return f'<div class="links">{" ".join(links)}</div>'


def _picture(out: Path, found: dict[str, Any]) -> str:
    """Return the thumbnail, embedded in the page, as a link to the picture."""
    folder = out / found["name"]
    try:
        data = base64.b64encode((folder / entries.THUMBNAIL).read_bytes()).decode()
    except OSError:
        return ""
    link = _relative(folder / entries.LAYOUT, out)
    return f'<a href="{link}"><img alt="" loading="lazy" src="data:image/png;base64,{data}"></a>'


def _relative(path: Path, out: Path) -> str:
    return quote(os.fsencode(Path(os.path.relpath(path, out)).as_posix()))
