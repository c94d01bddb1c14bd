"""The measured tables of README.md, docs/batch.md and docs/benchmarks.md, made from one file of results.

    build/venv/bin/python -m tests.benchmarks documents

writes them anew. The measuring commands do so, too, after they have put their tables into results.json: give them
`--keep`. In a document a table stands between `<!-- figures: NAME -->` and `<!-- end -->`, and is not edited by hand;
`<!-- figures: NAME; rows: FIRST CELL; FIRST CELL -->` shows the rows that begin with these cells.
Each table in the file has its command, date and commit, the machine, the paths of the code that it measures, and a
digest of these, by which `outdated` finds the tables to be measured again.
"""

from __future__ import annotations

import datetime
import json
import os
import platform
import re
import shlex
import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from tools import steps

ROOT = steps.ROOT
RESULTS = Path(__file__).with_name("results.json")
DOCUMENTS = tuple(ROOT / name for name in ("README.md", "docs/batch.md", "docs/benchmarks.md"))
_PLACE = re.compile(r"(<!-- figures: ([\w-]+)(?:; rows: ([^\n]*))? -->\n).*?(<!-- end -->)", re.DOTALL)

# The code that tables measure.
_SOURCES = ("concurrency", "conformal", "geometry", "graph", "injective", "linear_algebra", "mesh", "parameterization")
SOLVING = (*(f"native/src/{folder}" for folder in (*_SOURCES, "quality")), "tools/solver_libraries.py")
PACKING = ("native/src/concurrency", "native/src/geometry", "native/src/layout", "native/packing")
RELAXING = (*SOLVING, "native/src/relaxation")
SEAMS = (*SOLVING, "native/seams")
OPERATOR = (
    *(*SOLVING, "native/src/layout", "native/packing"),
    *("addon/edit_mesh", "addon/operators/unwrap.py", "addon/unwrapping"),
    *(f"addon/core/{folder}" for folder in ("layout", "measure", "mesh", "solve")),
)
OVERLAY = ("addon/overlay", "addon/core/measure", "addon/edit_mesh", "native/src/quality")


class Table:
    """A table, printed row by row, which can be kept for the documents.

    Attributes:
        name: of its place in the documents.
        titles: of the columns.
        code: the paths of what it measures, beside this script.
        rows: the cells so far.
    """

    def __init__(self, name: str, titles: Sequence[str], code: Sequence[str], *, is_printed: bool = True) -> None:
        """Print the head."""
        self.name, self.titles, self.code, self.rows = name, list(titles), code, []  # type: ignore[var-annotated]
        self._is_printed = is_printed
        if is_printed:
            print(f"\n{_line(self.titles)}\n{'|---' * len(self.titles)}|", flush=True)

    def row(self, *cells: object) -> None:
        """Print and add a row; missing cells at the end are empty."""
        self.rows.append([str(cell) for cell in cells] + [""] * (len(self.titles) - len(cells)))
        if self._is_printed:
            print(_line(self.rows[-1]), flush=True)


def _line(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"


def keep(*tables: Table, command: str | None = None) -> None:
    """Put tables into the results, as measured now by the running `command`, and write the documents."""
    results = read()
    for table in tables:
        code = sorted({*table.code, _script()})
        results[table.name] = {
            "command": command or _command(),
            "date": datetime.datetime.now(datetime.timezone.utc).date().isoformat(),
            "commit": commit(),
            "machine": machine(),
            "code": code,
            "digest": digest(code),
            "titles": table.titles,
            "rows": table.rows,
        }
    write(results)
    write_documents()


def read() -> dict[str, dict[str, Any]]:
    """Return the results by the name of their table."""
    return json.loads(RESULTS.read_text(encoding="utf-8")) if RESULTS.exists() else {}


def write(results: dict[str, dict[str, Any]]) -> None:
    """Write the results, each row in one line."""
    text = json.dumps(dict(sorted(results.items())), indent=1, ensure_ascii=False)
    # What contains strings alone: rows, titles and paths.
    flat = re.compile(r"\[\s*((?:\"(?:[^\"\\]|\\.)*\",?\s*)+)\]")
    text = flat.sub(lambda found: f"[{re.sub(chr(10) + ' *', ' ', found[1]).strip()}]", text)
    RESULTS.write_text(text + "\n", encoding="utf-8")


def block(result: dict[str, Any], rows: Sequence[str] = ()) -> str:
    """Return a table of the results as the documents have it, with the command and the version below.

    `rows`, if any, are the first cells of the rows to show.

    Raises:
        ValueError: no row begins with one of these cells.
    """
    if not result["rows"]:
        return f"\nNot measured yet: `{result['command']}`.\n\n"
    if missing := sorted(set(rows) - {row[0] for row in result["rows"]}):
        raise ValueError(f"no rows begin with {missing}")
    shown = [row for row in result["rows"] if not rows or row[0] in rows]
    lines = [_line(result["titles"]), "|---" * len(result["titles"]) + "|", *map(_line, shown)]
    version = f"version {result['commit']} ({result['date']})" if result["commit"] else "an earlier version"
    return "\n" + "\n".join(lines) + f"\n\n`{result['command']}`, {version}{_where(result['machine'])}.\n\n"


def _where(machine: dict[str, Any]) -> str:
    words = [f"{machine['cores']} cores"] if machine.get("cores") else []
    words += [machine[key] for key in ("processor", "system", "blas") if machine.get(key)]
    return f": {', '.join(words)}" if words else ""


def updated(text: str, results: dict[str, dict[str, Any]]) -> str:
    """Return a document with its tables as the results have them; a place without results stays as it is.

    Raises:
        ValueError: it names a row that its table does not have.
    """

    def filled(found: re.Match[str]) -> str:
        if found[2] not in results:
            return found[0]
        return found[1] + block(results[found[2]], found[3].split("; ") if found[3] else ()) + found[4]

    return _PLACE.sub(filled, text)


def places(text: str) -> Iterator[str]:
    """Yield the names of the tables for which a document has a place."""
    return (found[2] for found in _PLACE.finditer(text))


def outside(text: str) -> str:
    """Return a document without its places."""
    return _PLACE.sub("", text)


def write_documents() -> None:
    """Write the tables into the documents, and print a line for each place whose table was never measured."""
    results = read()
    for path in DOCUMENTS:
        text = path.read_text(encoding="utf-8")
        path.write_text(updated(text, results), encoding="utf-8")
        for name in dict.fromkeys(places(text)):
            if name not in results:
                print(f"{path.name}: the table {name} was never measured, and stays as it is")


def outdated(results: dict[str, dict[str, Any]]) -> list[str]:
    """Return a line for each command whose tables were measured with other code than that of today."""
    tables: dict[str, list[str]] = {}
    # Most tables share most of their code.
    known: dict[str, str] = {}
    for name, result in results.items():
        if result["digest"] != digest(result["code"], known):
            tables.setdefault(result["command"], []).append(name)
    return [f"measured with older code: {', '.join(names)}; again: {command}" for command, names in tables.items()]


def digest(code: Sequence[str], known: dict[str, str] | None = None) -> str:
    """Return a value that changes with the files of these paths; `known` keeps that of each path for further calls."""
    known = {} if known is None else known
    for path in code:
        if path not in known:
            known[path] = steps.digest([ROOT / path if (ROOT / path).exists() else "gone"])
    return steps.digest(known[path] for path in code)[:16]


def machine() -> dict[str, Any]:
    """Return what the figures belong to: no names of hosts, users or folders."""
    from tests.benchmarks import bare_cholmod

    return {
        "cores": os.cpu_count(),
        "processor": _processor(),
        "system": _system(),
        "blas": bare_cholmod.blas(),
        "load": round(os.getloadavg()[0], 1),
        "python": platform.python_version(),
    }


def _processor() -> str:
    path = Path("/proc/cpuinfo")
    found = re.search(r"^model name\s*: (.*)$", path.read_text(), re.MULTILINE) if path.exists() else None
    return found[1] if found else platform.machine()


def _system() -> str:
    path = Path("/etc/os-release")
    found = re.search(r'^PRETTY_NAME="?([^"\n]*)', path.read_text(), re.MULTILINE) if path.exists() else None
    return found[1] if found else platform.system()


def _script() -> str:
    return Path(str(sys.modules["__main__"].__file__)).resolve().relative_to(ROOT).as_posix()


def _command() -> str:
    spec = sys.modules["__main__"].__spec__
    module = spec.name.removesuffix(".__main__") if spec else Path(_script()).stem
    words = [Path(word).name if Path(word).is_absolute() else word for word in sys.argv[1:]]
    return shlex.join(["build/venv/bin/python", "-m", module, *words])


def commit() -> str:
    """Return the commit, and whether files have changed since; empty outside of a repository."""

    def git(*words: str) -> str:
        done = subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True, check=False)
        return done.stdout.strip()

    # The results and the documents change while several commands measure.
    changed = git(
        "status", "--porcelain", "--untracked-files=no", "--", "addon", "native", "tests/benchmarks/*.py", "tools"
    )
    return git("rev-parse", "--short=8", "HEAD") + (" with changes" if changed else "")
