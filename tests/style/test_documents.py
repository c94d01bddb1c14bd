# SPDX-License-Identifier: GPL-3.0-or-later
"""Everything named in README.md and docs/ exists, their code runs, and the numbers of their pictures are current."""

import os
import platform
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from addon import locale
from tests.benchmarks import control_pictures, documents, paper_figures
from tests.module import meshes
from tools import steps

ROOT = Path(__file__).resolve().parents[2]
DOCUMENTS = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
FOLDERS = ("addon", "docs", "native", "tests", "tools")


def named(text):
    """Return the paths and modules in code spans and blocks, and the bare names of headers and sources."""
    paths = set(re.findall(rf"\b(?:{'|'.join(FOLDERS)})/[\w./-]*\w/?", text))
    modules = {name.replace(".", "/") + ".py" for name in re.findall(r"-m ((?:tests|tools)\.[\w.]+)", text)}
    headers = set(re.findall(r"(?<![\w/<>_-])([a-z]\w*\.(?:h|cpp))\b", text))
    return paths | modules, headers


def is_there(path):
    # A path may end before a placeholder, as native/src/ of native/src/<floor>/. A package is run by its __main__.py.
    return (ROOT / path).exists() or (ROOT / path).with_suffix("").joinpath("__main__.py").exists()


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_paths_exist(document):
    paths, headers = named(document.read_text(encoding="utf-8"))
    sources = {path.name for folder in ("native", "tests") for path in (ROOT / folder).rglob("*.*")}
    assert sorted(path for path in paths if not is_there(path)) == []
    assert sorted(headers - sources) == []


def test_the_scan_sees_paths_modules_and_headers():
    text = "`native/src/no.cpp`, `gone.h`: `tests/native/<floor>/test_x.cpp`; `python -m tests.benchmarks.none`"
    paths, headers = named(text)
    assert {"native/src/no.cpp", "tests/benchmarks/none.py", "tests/native/"} <= paths
    assert headers == {"gone.h"}
    assert not is_there("native/src/no.cpp")


MESSAGES = re.findall(r'^\| "([^"]+)" \|', (ROOT / "docs" / "troubleshooting.md").read_text(encoding="utf-8"), re.M)


def sentences():
    """Return all that the add-on says, and the sources of the module's messages, literals joined as compilers do."""
    sources = [*(ROOT / "native").rglob("*.cpp"), *(ROOT / "native").rglob("*.py")]
    text = "\n".join(path.read_text(encoding="utf-8") for path in sources)
    return "\n".join([*locale.table("de"), re.sub(r'"\s*\n\s*f?"', "", text)])


@pytest.mark.parametrize("message", MESSAGES)
def test_messages_of_troubleshooting_are_what_is_said(message):
    assert message in sentences()


# Names of Blender's own controls in the pages for artists.
OF_BLENDER = {
    *("Adjust Last Operation", "All by Trait", "Average Islands Scale", "Clean Up", "Degenerate Dissolve"),
    *("Merge by Distance", "Online Manual", "Pack Islands", "Round to Pixels"),
}


@pytest.mark.parametrize("name", ["guide", "troubleshooting", "limits"])
def test_controls_have_the_names_that_pages_for_artists_call_them_by(name):
    text, labels = (ROOT / "docs" / f"{name}.md").read_text(encoding="utf-8"), sentences()
    emphasized = re.findall(r"(?<!\*)\*([A-Z][^*\n]{2,40})\*(?!\*)", text)
    named_controls = {part for each in emphasized for part in re.split(r" > |, ", each)} - OF_BLENDER
    assert len(named_controls) > 3
    assert sorted(each for each in named_controls if each not in labels) == []


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_links_lead_somewhere(document):
    text = document.read_text(encoding="utf-8")
    for target in re.findall(r"\]\(([^)#\s]+)(?:#[\w-]+)?\)", text):
        assert "://" not in target, "nothing can be fetched here to see whether it is there"
        assert (document.parent / target).exists(), target


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_python_in_documents_compiles(document):
    for code in re.findall(r"```python\n(.*?)```", document.read_text(encoding="utf-8"), re.DOTALL):
        compile(code, document.name, "exec")


def module_code():
    """Return the blocks for the module's functions, of docs/scripting.md and then of docs/api.md.

    tests/blender/test_scripting.py and tests/module/test_gltf.py run the others.
    """
    pages = ((ROOT / "docs" / name).read_text(encoding="utf-8") for name in ("scripting.md", "api.md"))
    return [
        code
        for code in re.findall(r"```python\n(.*?)```", "".join(pages), re.DOTALL)
        if not re.search(r"\bbpy\b|\bassets\b", code)
    ]


@pytest.mark.parametrize(
    ("vertices", "faces"), [meshes.saddle_quads(13), meshes.bulge(15, 0.8), meshes.bumpy_disk(300)], ids=len
)
def test_code_for_the_module_runs(vertices, faces):
    _, triangles = control_pictures.triangulated((vertices, faces)) if faces.shape[1] == 4 else (vertices, faces)
    names = {"V": vertices, "F": triangles}
    sides = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    sides, counts = np.unique(sides, axis=0, return_counts=True)
    names["border"] = np.isin(np.arange(len(vertices)), sides[counts == 1])
    names |= {"image": np.zeros((8, 8, 3), np.uint8), "old_uv": vertices[:, :2], "colors": np.ones((len(vertices), 3))}
    for code in module_code():
        exec(compile(code, "docs", "exec"), names)
    for name in ("mesh", "pushed", "even", "grain"):
        uv = names[name].uv
        assert np.isfinite(uv).all(), name
        assert np.ptp(uv, axis=0).min() > 0.1, name
    assert np.array_equal(names["vmapping"][names["faces"]], triangles)
    assert 1 < names["sc"].distortion(vertices, triangles, names["uv"]).mean_qc < 1.2


def test_code_for_the_module_is_there():
    assert len(module_code()) == 2


@pytest.mark.parametrize("example", control_pictures.EXAMPLES, ids=lambda example: example.name)
def test_each_picture_of_the_guide_has_the_numbers_of_today_among_the_benchmarks(example):
    guide, numbers = ((ROOT / "docs" / name).read_text(encoding="utf-8") for name in ("guide.md", "benchmarks.md"))
    assert example.written(example.maps()) in " ".join(numbers.split())
    assert f"![{example.shown}](images/{example.name}.png)" in guide
    assert (control_pictures.IMAGES / f"{example.name}.png").stat().st_size < 60_000


@pytest.mark.parametrize("name", ["guide.md", "troubleshooting.md", "limits.md"])
def test_pages_for_artists_have_no_statistics(name):
    page = (ROOT / "docs" / name).read_text(encoding="utf-8")
    assert not re.search(r"tests\.benchmarks|\bQC\b|standard deviation|\d\.\d{3}", page)


@pytest.mark.parametrize("figure", paper_figures.FIGURES, ids=lambda figure: figure.name)
def test_the_page_of_figures_has_the_measures_of_today(figure):
    page = (ROOT / "docs" / "figures.md").read_text(encoding="utf-8")
    assert paper_figures.section(figure, figure.maps()) in page
    assert (paper_figures.IMAGES / figure.picture).stat().st_size < 60_000


def test_a_mesh_of_the_user_takes_the_place_of_ours(tmp_path):
    vertices, triangles = paper_figures.holed()
    rows = [f"v {x} {y} {2 * z}" for x, y, z in vertices] + ["f {} {} {}".format(*face) for face in triangles + 1]
    (tmp_path / "car.obj").write_text("\n".join(rows))
    taken, ours = ({figure.name: figure for figure in paper_figures.FIGURES}[name] for name in ("car", "holed"))
    assert len(taken.maps(tmp_path)[0].uv) == len(ours.maps(tmp_path)[0].uv) == len(vertices)


@pytest.mark.parametrize("document", documents.DOCUMENTS, ids=lambda path: path.name)
def test_tables_of_figures_are_those_of_the_results(document):
    text = document.read_text(encoding="utf-8")
    assert documents.updated(text, documents.read()) == text, "run build/venv/bin/python -m tests.benchmarks documents"


def test_a_table_of_figures_has_one_place_and_there_are_no_others():
    texts = {path.name: path.read_text(encoding="utf-8") for path in documents.DOCUMENTS}
    names = [name for text in texts.values() for name in documents.places(text)]
    assert len(names) == len(set(names))
    assert set(names) <= set(documents.read())
    prose = {name: documents.outside(text) for name, text in texts.items()}
    assert not re.search(r"^\|", prose["benchmarks.md"], re.M)
    assert re.findall(r"^(\|.*)\n\|[-|]+$", prose["README.md"], re.M) == []
    assert re.findall(r"\d (?:s|ms|MB|GB)\b", prose["README.md"] + prose["benchmarks.md"]) == []


def test_results_name_no_machine_and_no_folder():
    text = documents.RESULTS.read_text(encoding="utf-8")
    assert str(ROOT) not in text
    assert not re.search(rf'"/|[" ]/(?:home|root|tmp|work)\b|\b{re.escape(platform.node())}\b', text)


@pytest.fixture
def kept(tmp_path, monkeypatch):
    """A project with one file of code and one document, for one table."""
    for module, name in ((documents, "ROOT"), (steps, "ROOT")):
        monkeypatch.setattr(module, name, tmp_path)
    monkeypatch.setattr(documents, "RESULTS", tmp_path / "results.json")
    monkeypatch.setattr(documents, "DOCUMENTS", (tmp_path / "page.md",))
    monkeypatch.setattr(documents, "_script", lambda: "script.py")
    (tmp_path / "script.py").write_text("measure()\n")
    (tmp_path / "code").mkdir()
    (tmp_path / "code" / "own.cpp").write_text("1\n")
    (tmp_path / "page.md").write_text("Before.\n\n<!-- figures: own -->\n<!-- end -->\n\nAfter.\n")
    table = documents.Table("own", ("what", "s"), ("code",), is_printed=False)
    table.row("a", f"{0.5:.2f}")
    table.row("b")
    documents.keep(table, command="measure --keep")
    return tmp_path


def test_a_measured_table_is_kept_and_written_into_its_place(kept):
    text = (kept / "page.md").read_text()
    assert "Before.\n\n<!-- figures: own -->\n\n| what | s |\n|---|---|\n| a | 0.50 |\n| b |  |\n\n`measure" in text
    assert text.endswith("<!-- end -->\n\nAfter.\n")
    result = documents.read()["own"]
    assert result["code"] == ["code", "script.py"]
    assert result["machine"]["cores"] >= 1
    assert '   ["a", "0.50"],\n' in (kept / "results.json").read_text(), "a row in one line"
    edited = text.replace("0.50", "0.49")
    assert documents.updated(edited, documents.read()) == text


def test_a_place_for_a_table_that_was_never_measured_stays(kept, capsys):
    """A script keeps its own table, whatever others have not measured yet."""
    other = "<!-- figures: other -->\nAs it was.\n<!-- end -->\n"
    page = kept / "page.md"
    page.write_text(other + page.read_text().replace("0.50", "0.49"))
    documents.write_documents()
    assert page.read_text().startswith(other)
    assert "0.50" in page.read_text()
    assert capsys.readouterr().out == "page.md: the table other was never measured, and stays as it is\n"


def test_a_place_may_show_some_rows_and_fails_on_others(kept):
    table = documents.Table("own", ("what", "s"), ("code",), is_printed=False)
    for cells in (("a, first", "1"), ("b", "2"), ("a, first", "3")):
        table.row(*cells)
    documents.keep(table, command="measure --keep")
    place = "<!-- figures: own; rows: {} -->\n<!-- end -->\n"
    shown = documents.updated(place.format("a, first"), documents.read())
    assert "|---|---|\n| a, first | 1 |\n| a, first | 3 |\n\n`measure --keep`" in shown
    assert documents.updated(shown, documents.read()) == shown
    assert list(documents.places(shown)) == ["own"]
    with pytest.raises(ValueError, match="c"):
        documents.updated(place.format("a, first; c"), documents.read())


@pytest.mark.parametrize("change", ["edited", "more", "gone", "script"])
def test_a_table_is_outdated_once_its_code_has_changed(kept, change):
    assert documents.outdated(documents.read()) == []
    own = kept / "code" / "own.cpp"
    {
        "edited": lambda: own.write_text("2\n"),
        "more": lambda: own.with_name("more.cpp").write_text("1\n"),
        "gone": lambda: (own.unlink(), own.parent.rmdir()),
        "script": lambda: (kept / "script.py").write_text("measure_better()\n"),
    }[change]()
    assert documents.outdated(documents.read()) == ["measured with older code: own; again: measure --keep"]


def test_a_run_of_all_tests_ends_with_the_outdated_tables_and_then_its_summary(tmp_path):
    (tmp_path / "conftest.py").write_text(
        "from tests.benchmarks import documents\nfrom tests.conftest import pytest_terminal_summary\n"
        "documents.outdated = lambda _results: ['measured with older code: own; again: measure']\n"
    )
    (tmp_path / "test_one.py").write_text("def test_one():\n    pass\n")
    environ = {**os.environ, "PYTHONPATH": str(ROOT)}
    lines = {}
    for named in ([], ["test_one.py"]):
        command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", *named]
        done = subprocess.run(command, cwd=tmp_path, env=environ, capture_output=True, text=True, check=True)
        lines[len(named)] = done.stdout.splitlines()
    assert lines[0][-2] == "measured with older code: own; again: measure"
    assert "1 passed" in lines[0][-1]
    assert "older code" not in "".join(lines[1])
