# SPDX-License-Identifier: GPL-3.0-or-later
"""Everything that artists read can be translated, is looked up where it is shown, and is in every table."""

import ast
import inspect
import re
from collections import Counter
from pathlib import Path
from string import Formatter

import numpy as np
import pytest
from spectral_unwrap import locale
from spectral_unwrap.core import native
from spectral_unwrap.core.measure.defects import Defects
from spectral_unwrap.core.measure.map_view import IslandNumbers
from spectral_unwrap.core.measure.quality import MapQuality
from spectral_unwrap.core.measure.summary import Strain, Summary, Unevenness
from spectral_unwrap.core.words import texts, translation

ADDON = Path(__file__).resolve().parents[3] / "addon"
TEXTS = (ADDON / "core" / "words" / "texts.py").read_text(encoding="utf-8")
# bl_info must be literals in the add-on's __init__.
OTHERS = sorted(set(ADDON.rglob("*.py")) - {ADDON / "core" / "words" / "texts.py", ADDON / "__init__.py"})
TABLES = {language: locale.table(language) for language in locale.LANGUAGES}
NAN = float("nan")
# What makes Blender's properties, given their names and descriptions first.
PROPERTIES = "switch|choice|numbers?|share"


def is_message(node):
    """Return whether this is a text with words or fields, and no identifier as Blender has them."""
    is_text = isinstance(node, ast.Constant) and isinstance(node.value, str)
    return is_text and bool(re.search("[A-Za-z]", node.value)) and not re.fullmatch("[A-Z][A-Z0-9_]*", node.value)


def messages(tree):
    """Return the messages in a piece of code: no docstrings, keys of dictionaries or formats of numbers."""
    silent = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr):
            silent.add(id(node.value))
        elif isinstance(node, ast.Dict):
            silent.update(map(id, node.keys))
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "format":
            silent.update(id(part) for argument in node.args[1:] for part in ast.walk(argument))
    return {node.value for node in ast.walk(tree) if is_message(node) and id(node) not in silent}


def is_looked_up(node):
    """Return whether Blender or `translate` looks up what this piece of code says."""
    if isinstance(node, ast.keyword):
        # Of properties, layouts and undo steps.
        return node.arg in {"name", "description", "text", "message"}
    if isinstance(node, ast.Assign):
        return ast.unparse(node.targets[0]) in {"bl_label", "bl_description", "bl_category"}
    if isinstance(node, ast.Tuple) and len(node.elts) == 3:
        # An item of an enumeration.
        return bool(re.fullmatch(r"choices\.\w+|'[A-Z_]+'", ast.unparse(node.elts[0])))
    return isinstance(node, ast.Call) and bool(
        re.fullmatch(rf"translate|texts\.\w+|{PROPERTIES}", ast.unparse(node.func))
    )


def labels(source):
    """Return the messages of a file that are looked up, without names of Python's."""
    found = set().union(*(messages(node) for node in ast.walk(ast.parse(source)) if is_looked_up(node)))
    return {text for text in found if not re.fullmatch("[a-z0-9_.]+", text)}


def sentences(source):
    """Return the texts of several words in a file, except docstrings, types, shaders and regular expressions."""
    nodes = list(ast.walk(ast.parse(source)))
    silent = {id(node.value) for node in nodes if isinstance(node, ast.Expr)}
    for node in nodes:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) in {"_VERTEX", "_FRAGMENT", "_ENTRY"}:
            silent |= {id(part) for part in ast.walk(node)}
    found = {node.value.strip() for node in nodes if is_message(node) and id(node) not in silent}
    return {text for text in found if " " in text and " | " not in text}


def in_pieces(source):
    """Return the lines with a sentence that no table could have: filled in before it is looked up, or glued."""
    found = []
    for node in ast.walk(ast.parse(source)):
        is_bad = isinstance(node, ast.JoinedStr)
        if isinstance(node, ast.BinOp):
            is_bad = is_message(node.left) or is_message(node.right)
        elif isinstance(node, ast.AugAssign):
            is_bad = is_message(node.value)
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
            is_bad = is_message(node.func.value)
        if is_bad:
            found.append(node.lineno)
    return found


def test_sentences_are_whole():
    assert in_pieces(TEXTS) == []


@pytest.mark.parametrize("path", OTHERS, ids=lambda path: str(path.relative_to(ADDON)))
def test_what_stands_beside_its_operator_is_looked_up(path):
    source = path.read_text(encoding="utf-8")
    assert sentences(source) - labels(source) == set()


def test_the_scan_sees_what_is_not_looked_up():
    source = '''
def draw(self):
    """Draw."""
    self.report({"INFO"}, "Not looked up")
    self.layout.label(text="Go" if self.goes else translate("Stop it"))
    items = (("A", "First", "The first one"), (choices.SECOND, "Second", "The second one"))
    threading.Thread(name="spectral_unwrap")
'''
    assert sentences(source) - labels(source) == {"Not looked up"}
    assert labels(source) == {"Go", "Stop it", "First", "The first one", "Second", "The second one"}


@pytest.mark.parametrize(
    "line",
    [
        'f"{count} islands"',
        'noun + "s"',
        '"%d islands" % count',
        'text += " and more"',
        '" or ".join(kinds)',
        '"{n} islands".format(n=2)',
    ],
)
def test_the_scan_sees_pieces(line):
    assert in_pieces(f"pass\n{line}\n") == [2]
    assert in_pieces('", ".join(names)\ntranslate("{n} islands").format(n=2)\n') == []


def fields(text):
    """Return the sorted names of the fields of a text; every field must be a plain name."""
    found = []
    for _, field, spec, conversion in Formatter().parse(text):
        if field is not None:
            assert field.isidentifier() and not spec and not conversion, text
            found.append(field)
    return sorted(found)


@pytest.mark.parametrize("language", TABLES)
def test_tables_have_what_is_said_and_nothing_else(language):
    of_files = set().union(*(labels(path.read_text(encoding="utf-8")) for path in OTHERS))
    said = messages(ast.parse(TEXTS)) | of_files | set(native.spectral_conformal().hosts.message_templates())
    assert len(of_files) > 300 and len(said) > 700
    assert sorted(said - set(TABLES[language])) == [], "not translated"
    assert sorted(set(TABLES[language]) - said) == [], "said no more"


@pytest.mark.parametrize("language", TABLES)
def test_translations_have_the_fields_of_their_sources(language):
    for source, translated in TABLES[language].items():
        assert translated and translated == translated.strip(), source
        assert fields(translated) == fields(source)


def test_no_table_says_a_thing_twice():
    for path in (ADDON / "locale").glob("*.po"):
        texts_of_file = Counter(re.findall(r"^msgid (.*)$", path.read_text(encoding="utf-8"), re.MULTILINE))
        assert [text for text, count in texts_of_file.items() if count > 1] == []


def test_tables_are_read_as_translators_write_them(monkeypatch):
    """Editors of such files break long lines, and keep what is said no more as comments."""
    written = """# A comment
msgid ""
msgstr "Language: xx\\n"

#, fuzzy
msgid "One {n}"
msgstr "Eins \\"{n}\\""

msgid ""
"Two, "
"three"
msgstr ""
"Zwei, "
"drei"

#~ msgid "Gone"
#~ msgstr "Weg"
"""
    monkeypatch.setattr(locale, "get_data", lambda _package, name: {"xx.po": written.encode()}[name])
    assert locale.table("xx") == {"One {n}": 'Eins "{n}"', "Two, three": "Zwei, drei"}


@pytest.fixture
def looked_up():
    """Translate into capitals, and return the texts looked up so far."""
    asked = set()

    def shout(text):
        asked.add(text)
        parts = Formatter().parse(text)
        return "".join(said.upper() + ("" if field is None else "{" + field + "}") for said, field, _, _ in parts)

    translation.use(shout)
    yield asked
    translation.use(None)


def summary(count=0, **changed):
    """Return a summary in which every count has this value."""
    once = {"solved": count, "flipped": count, "overlapping": count, "unfolded": count, "embedded": count}
    reasons = {"failures": Counter(A=count), "repairs": Counter(A=count), "pinned": Counter(lscm=count, spectral=1)}
    rest = {"mean_qc": 1.5, "max_qc": 2.0, "mean_qc_change": (1.5, 1.25), "refused": ("A: B",)}
    return Summary(**{**once, **reasons, **rest, **changed})


def numbers(mean_qc=1.5, faces=2):
    return IslandNumbers(faces, mean_qc, 2.0, 0.5, 1, 1, 1)


def defects(flag):
    return [Defects(*(np.array([flag]),) * 3, np.zeros(1, int))]


LABEL, LOOKS = texts.UNWRAP_LABEL, [identifier for identifier, _, _ in texts.LOOK_ITEMS]
# Arguments that make every function return each of its sentences; anything else has no small letters.
CALLS = {
    "canceled": [(LABEL,)],
    "progress": [(LABEL, 5, ""), (LABEL, 5, "PHASE")],
    "printed_progress": [(LABEL, 5, "PHASE")],
    "could_not_follow": [("A",)],
    "not_drawn": [(LABEL, "A")],
    "information": [(summary(n, mean_qc=qc), 1.0) for n, qc in ((0, 1.5), (1, 1.5), (2, 1.5), (2, np.inf))]
    + [(summary(1), 1.0, 0.5)],
    "look": [(look, unit) for look in LOOKS for unit in ("", "M")],
    "density": [(512.0, "M"), (512.0, "")],
    "density_unit": [("M",), ("",)],
    "densities": [(2.0, 2.0, 2.0, 1, "M"), (2.0, 1.0, 3.0, 2, "M")],
    "density_set": [(512.0, 1, "M"), (512.0, 2, "")],
    "density_equalized": [(512.0, 2, factors, "M") for factors in (0, 1, 2)],
    "density_factor": [(1.5, 1), (1.5, 2)],
    "last_fill": [(0.5,), (None,)],
    "relaxed": [(0.0, 1, 0, 0, 1.0), (0.5, 1, 1, 1, 1.0), (0.5, 2, 2, 2, 1.0), (0.5, 2, 0, 0, 1.0)],
    "relax_status": [(0.5, 1), (0.5, 2)],
    "packed": [(1, 0, 0.5, 1.0, False), (2, 1, 0.5, 1.0, True)],
    "new_textures": [("A", 1, 1, 1.0), ("A", 2, 2, 1.0)],
    "kept_textures": [((),), (tuple(("A", reason) for reason in texts._KEPT_TEXTURES),)],
    "coarser_textures": [({},), ({"A": 2.0},)],
    "copied_materials": [((),), (("A",),)],
    "counted": [(n, texts.UNUSED_EXTENDERS) for n in (0, 1, 2)],
    "without_room": [(0, 1), (1, 1), (1, 2)],
    "pack_status": [(None, 0), (0.5, 1), (0.5, 2, 0), (0.5, 2, 3)],
    "look_value": [(look, 2.0) for look in LOOKS],
    "legend_ends": [(look, 1.0, 2.0, 3.0) for look in LOOKS],
    "too_many_faces": [(["CUBE"],), ([],)],
    "stacked": [(0, 0, None, 0, 8), (1, 2, 0.5, 1, 8), (2, 5, 0.5, 2, 8)],
    "figure": [(look, numbers(qc), 2.0, "M") for look in LOOKS for qc in (1.5, NAN)],
    "legend_object": [("A", numbers(qc), 2.0, "M") for qc in (1.5, NAN)],
    "legend_more": [(0,), (2,)],
    "legend_numbers": [(texts.LEGEND_MESH, numbers()), (texts.LEGEND_MESH, numbers(NAN))],
    "island_row": [(1, 1.5, 2.0, 1, 1)],
    "face_numbers": [(1.5, 1.0, "2", *flags) for flags in ((True, True), (True, False), (False, True))],
    "solver": [("E", ""), ("E", "K")],
    "unfolded": [(summary(1),), (summary(2, mean_qc_change=None),)],
    "failures": [(summary(1),), (summary(2),), (summary(1, lacks_seams=True),)],
    "repairs": [(summary(1),), (summary(2),)],
    "with_similar": [("A", 0), ("A", 1)],
    "folds": [(0, 0), (1, 2)],
    "strained": [(Strain(count, 2.5),) for count in (0, 1, 2)],
    "uneven": [(Unevenness(count, 0.7),) for count in (0, 1, 2)],
    "selected_distorted": [(0,), (1,), (2,)],
    "in_place": [(count, count) for count in (0, 1, 2)],
    "newly_beyond_tile": [(0,), (1,), (2,)],
    "newly_covering": [(0,), (1,), (2,)],
    "pinned": [(summary(1),), (summary(1, pinned=Counter(lscm=1)),)],
    "average_density": [(["A"],), ([],)],
    "object_scale": [([(1.0, 1.0, 2.0)], [False]), ([(1.0, 1.0, 1.0)], [True])],
    "added_extenders": [(1, 1, True), (2, 0, False)],
    "selected_failed": [(0, 0), (1, 1), (2, 2)],
    "selected_defects": [
        (defects(is_bad), *kinds) for is_bad in (True, False) for kinds in ((True, True), (True, False), (False, True))
    ],
    "marked": [(1, 0, "2"), (2, 1, "2"), (0, 2, "2")],
    "hinted": [(hint, edges) for hint, *_ in texts.SEAM_HINTS for edges in (1, 2)],
    "aligned": [(0,), (1,), (2,)],
    "constrained": [("Grid", 1), ("Grid", 2)],
    "nothing_to_suggest": [("AUTO", True), ("AUTO", False), ("ANGLE", False)],
    "preview_by_angle": [(30.0, 1, "2"), (30.0, 2, "2")],
    "islands": [(1,), (2,)],
    "found_style": [(("hard",),), (("organic", "hard"),), ((),)],
    "without_suggestion": [(["A."], ["B"]), ([""], ["B"])],
    "preview": [(2, 2, "2", "2"), (1, 2, "1", "2")],
    "status": [("Spectral Pack", "A", "B")],
    "expected": [(MapQuality(0.5, qc), MapQuality(1.0, qc)) for qc in (1.5, NAN)]
    + [(MapQuality(0.5, NAN), MapQuality(1.0, 1.5))],
    "no_module": [("A",)],
}


def test_functions_say_nothing_that_was_not_looked_up(looked_up):
    functions = dict(inspect.getmembers(texts, lambda each: inspect.getmodule(each) is texts and callable(each)))
    assert set(CALLS) == {name for name in functions if not name.startswith("_")}
    for name, calls in CALLS.items():
        for arguments in calls:
            said = functions[name](*arguments)
            assert not re.search("[a-z]", said if isinstance(said, str) else " ".join(said)), (name, said)
    bodies = [node for node in ast.parse(TEXTS).body if isinstance(node, ast.FunctionDef)]
    assert sorted(set().union(*map(messages, bodies)) - looked_up) == [], "not brought out by the calls above"


def shown_as_it_is(source):
    """Return the constants of `texts` that a file neither looks up nor gives to `texts`, or Blender, to look up."""
    tree = ast.parse(source)
    parents = {child: node for node in ast.walk(tree) for child in ast.iter_child_nodes(node)}
    calls = [node for node in ast.walk(tree) if isinstance(node, ast.Call) and ast.unparse(node.func) == "translate"]
    own = {ast.unparse(each) for call in calls for each in ast.walk(call) if isinstance(each, ast.Attribute)}
    found = []
    for node in ast.walk(tree):
        if not (isinstance(node, ast.Attribute) and ast.unparse(node.value) == "texts"):
            continue
        value = getattr(texts, node.attr, None)
        if not isinstance(value, str) or re.fullmatch("[A-Z_]+", value):
            continue
        user = parents[node]
        while isinstance(user, ast.IfExp):
            user = parents[user]
        # Labels and descriptions of classes and properties, words in layouts, names of undo steps.
        is_blenders = isinstance(user, ast.keyword) and user.arg in {"name", "description", "text", "message"}
        if isinstance(user, ast.Assign):
            name = ast.unparse(user.targets[0])
            # Or attributes of a class that one of its methods looks up.
            is_blenders = name.startswith("bl_") or f"self.{name.removeprefix('self.')}" in own
        is_looked_up = isinstance(user, ast.Call) and re.fullmatch(
            rf"translate|texts\.[a-z_]+|.*\.pgettext_data|{PROPERTIES}", ast.unparse(user.func)
        )
        if not (is_blenders or is_looked_up or isinstance(user, ast.arguments)):
            found.append(node.attr)
    return found


def test_constants_are_looked_up_where_they_are_shown():
    files = {path: path.read_text(encoding="utf-8") for path in ADDON.rglob("*.py")}
    assert {str(path): shown_as_it_is(text) for path, text in files.items() if shown_as_it_is(text)} == {}
    assert shown_as_it_is("self.report({'INFO'}, texts.NO_UV_MAP)") == ["NO_UV_MAP"]
    assert shown_as_it_is("note = texts.NO_UV_MAP if a else texts.NOTHING_SELECTED") == [
        "NO_UV_MAP",
        "NOTHING_SELECTED",
    ]
    assert shown_as_it_is("self.report({'INFO'}, translate(texts.NO_UV_MAP))\nx.label(text=texts.SEAMS_LABEL)") == []
    shown = "class Shown:\n    nothing = texts.NO_UV_MAP\n    def show(self):\n        return {}"
    assert shown_as_it_is(shown.format("self.nothing")) == ["NO_UV_MAP"]
    assert shown_as_it_is(shown.format("translate(self.nothing)")) == []


def test_without_a_table_texts_stay_as_they_are(looked_up):
    assert translation.translate("Extender") == "EXTENDER"
    assert translation.translate("") == ""
    assert looked_up == {"Extender"}
    translation.use(None)
    assert translation.translate("Extender") == "Extender"


def test_error_of_a_thread_is_worded_by_who_reads_it(monkeypatch):
    monkeypatch.setattr(native, "_name", lambda: "no_such_module")
    with pytest.raises(native.NativeModuleError) as raised:
        native.spectral_conformal()
    assert str(raised.value).startswith("The compiled module")
    translation.use(lambda text: text.replace("The compiled", "Compiled"))
    try:
        assert str(raised.value).startswith("Compiled module")
    finally:
        translation.use(None)
