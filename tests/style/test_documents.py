# SPDX-License-Identifier: GPL-3.0-or-later
"""Everything named in README.md and docs/ exists, their code runs, and the numbers of their pictures are current."""

import re
from pathlib import Path

import numpy as np
import pytest

from tests.benchmarks import control_pictures, paper_figures
from tests.module import meshes

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
    """Return all sources that have messages, literals that the compiler joins joined."""
    sources = [ROOT / "addon/core/words/texts.py", *(ROOT / "native").rglob("*.cpp"), *(ROOT / "native").rglob("*.py")]
    text = "\n".join(path.read_text(encoding="utf-8") for path in sources)
    return re.sub(r'"\s*\n\s*f?"', "", text)


@pytest.mark.parametrize("message", MESSAGES)
def test_messages_of_troubleshooting_are_what_is_said(message):
    assert message in sentences()


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
    names = {"V": vertices, "F": triangles, "seams": triangles[:3, :2]}
    sides = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    sides, counts = np.unique(sides, axis=0, return_counts=True)
    names["border"] = np.isin(np.arange(len(vertices)), sides[counts == 1])
    for code in module_code():
        exec(compile(code, "docs", "exec"), names)
    for name in ("result", "lower", "flat", "pushed", "even", "grain"):
        uv = names[name].uv
        assert np.isfinite(uv).all(), name
        assert np.ptp(uv, axis=0).min() > 0.1, name
    assert names["seams"].shape[1:] == (2,)
    assert np.array_equal(names["vmapping"][names["faces"]], triangles)
    assert names["lower"].polish_steps
    assert 1 < names["measured"].mean_qc < 1.2
    assert names["defects"].overlapping.shape == (len(triangles),)


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
