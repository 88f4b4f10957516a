# SPDX-License-Identifier: GPL-3.0-or-later
"""Every text of the panels is in the table of every language."""

from __future__ import annotations

import ast
import errno
import os
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
import sparse_mocap
from sparse_mocap import quality
from sparse_mocap.capture.link import State

from blender_addon.languages import german, german_core
from blender_addon.session import (
    bake,
    calibrating,
    database,
    demo,
    imported,
    mapping,
    match,
    pose_guide,
    reconstruct,
    sensors,
    training,
)
from blender_addon.session.free_motions import FREE_MOTIONS
from blender_addon.session.names import shown_site

ADDON = Path(__file__).resolve().parents[3] / "blender_addon"
LANGUAGES = {"german": german.TEXTS}

SHOWN = [*sorted((ADDON / "ui").glob("*.py")), ADDON / "scene/prompt.py"]
SHOWN += [ADDON / f"scene/{name}.py" for name in ("latent_view", "pose_guide", "sensor_graph")]
SHOWN += [ADDON / "ops/sensor_table.py"]
DEFINED = [*sorted((ADDON / "ops").glob("*.py")), ADDON / "scene/settings.py"]
DEFINED += [
    ADDON / f"scene/{name}.py"
    for name in ("preferences", "clips", "mapping", "training", "teaching")
]

NOT_TEXT = re.compile(r"[A-Z0-9_]+|SPARSEMOCAP\w+|sparse_mocap.*|[a-z_]+(\.[a-z_]+)+|.{0,2}")
IGNORED = {
    "FileHandler",
    " ...",
    "Select a character with a take that was reconstructed since Blender was started",  # an error
    "3D View",  # Blender's own name of a keymap
    *("folder", "calibration"),  # names of settings
}
NAMED = ("name", "description", "bl_label", "bl_description", "text", "heading", "title")


def texts_in(path: Path) -> Iterator[tuple[int, str]]:
    """The literal texts of a file that draws: sentences, and words with a capital."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    left_out = {id(part) for node in ast.walk(tree) for part in _not_shown(node)}
    for node in ast.walk(tree):
        if not isinstance(node, ast.Constant) or not isinstance(node.value, str):
            continue
        text = node.value
        is_text = " " in text.strip() or text[:1].isupper() or "{" in text
        if id(node) not in left_out and is_text and not NOT_TEXT.fullmatch(text):
            yield node.lineno, text


def _not_shown(node: ast.AST) -> Iterator[ast.AST]:
    """Docstrings, and what stands in f-strings and in errors."""
    if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):
        for first in node.body:
            if isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant):
                yield first.value
    if isinstance(node, ast.JoinedStr | ast.Raise):
        yield from ast.walk(node)


def definitions_in(path: Path) -> Iterator[tuple[int, str]]:
    """The names and descriptions of the classes and properties that a file defines."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        pairs: list[tuple[str, ast.expr]] = []
        if isinstance(node, ast.Call):
            pairs = [(keyword.arg or "", keyword.value) for keyword in node.keywords]
        elif isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            pairs = [(node.targets[0].id, node.value)]
        elif isinstance(node, ast.Dict):
            pairs = [
                (str(key.value), value)
                for key, value in zip(node.keys, node.values, strict=True)
                if isinstance(key, ast.Constant)
            ]
        elif isinstance(node, ast.Tuple) and len(node.elts) == 3:  # of a menu
            values = [part.value for part in node.elts if isinstance(part, ast.Constant)]
            if len(values) == 3 and all(isinstance(value, str) for value in values):
                pairs = [("name", node.elts[1]), ("description", node.elts[2])]
        for name, value in pairs:
            if name in NAMED and isinstance(value, ast.Constant) and isinstance(value.value, str):
                yield value.lineno, value.value


def known_texts() -> list[str]:
    """What the panels show that is kept without Blender."""
    advice = [match.advice_for("poor"), match.advice_for("fair"), match.ODD_SENSOR]
    core_advice = [getattr(quality, name) for name in ("_UNLIKE_ADVICE", "_ALIKE_ADVICE")]
    advice += [text[:1].upper() + text[1:] for text in core_advice]
    jobs = [database.BUILDING, demo.MAKING, demo.TRYING, imported.IMPORTING, bake.PLACING_AGAIN]
    jobs += [reconstruct.RECONSTRUCTING, sensors.STARTING_LIVE, sensors.SAVING_TAKE]
    jobs += [training.TRAINING]
    return [
        *advice,
        *jobs,
        calibrating.CALIBRATING,
        *(phase.text for phase in calibrating.PHASES),
        pose_guide.CALIBRATING_BY_POSES,
        *pose_guide.POSE_TEXTS.values(),
        *(pose_guide.READY, pose_guide.HOLD, pose_guide.MISSED),
        *(pose_guide.MIRRORED, pose_guide.FROM_RIGHT),
        "very good",  # how well a motion and its take agree
        *("searching", "fitting", "smoothing"),  # what the core says it is doing
        *("finding how the sensor is worn", "placing the feet"),
        *mapping.LABELS.values(),
        *(f"Choose a {what} first" for what in ("motion database", "take")),
        "Train or open a model first",
        *(shown_site(site) for site in sparse_mocap.site_names()),
        *(found.terms for found in FREE_MOTIONS),
        *(state.value.capitalize() for state in State),
        *("good", "fair", "poor", "missing", "no data"),
    ]


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_text_is_in_the_table(language: str) -> None:
    table = LANGUAGES[language]
    shown = [(path, *found) for path in SHOWN for found in texts_in(path)]
    defined = [(path, *found) for path in DEFINED for found in definitions_in(path)]
    assert len(shown) > 80
    assert len(defined) > 150
    missing = [
        f"{path.name}:{line}: {text}"
        for path, line, text in [*shown, *defined]
        if text not in table and text not in IGNORED and not NOT_TEXT.fullmatch(text)
    ]
    assert missing == []
    assert [text for text in known_texts() if text not in table] == []


def reported_in(path: Path) -> Iterator[tuple[int, str]]:
    """The lines that a file reports or raises, {} where something is filled in."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        said: list[ast.expr] = []
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.args:
            said = [node.args[0]] if node.func.id in ("InputError", "tr_line") else []
        elif isinstance(node, ast.FunctionDef) and node.name in ("act", "apply"):
            returned = [inner for inner in ast.walk(node) if isinstance(inner, ast.Return)]
            said = [inner.value for inner in returned if inner.value is not None]
        for text in filter(None, map(_template, said)):
            yield node.lineno, text


def _template(node: ast.expr) -> str:
    parts = node.values if isinstance(node, ast.JoinedStr) else [node]
    if not all(isinstance(part, ast.Constant | ast.FormattedValue) for part in parts):
        return ""
    return "".join(str(part.value) if isinstance(part, ast.Constant) else "{}" for part in parts)


def _written() -> list[Path]:
    return [path for part in ("ops", "scene", "session") for path in (ADDON / part).glob("*.py")]


def _templates_in(path: Path) -> Iterator[str]:
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.JoinedStr | ast.Constant):
            yield _template(node)


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_report_is_in_the_table(language: str) -> None:
    table = {re.sub(r"\{\w+\}", "{}", text) for text in LANGUAGES[language]}
    found = [(path, *report) for path in sorted(_written()) for report in reported_in(path)]
    assert len(found) > 100
    missing = [f"{path.name}:{line}: {text}" for path, line, text in found if text not in table]
    assert missing == []


def _said_by_the_package() -> str:
    """All its sources, with what is put together from several literals in one piece."""
    files = [*(ADDON.parent / "bindings/sparse_mocap").rglob("*.py")]
    files += (ADDON.parent / "core/sparse_mocap").rglob("*.cpp")
    sources = "".join(path.read_text(encoding="utf-8") for path in files)
    joined = re.sub(r"[\"']\s+\+?\s*f?[\"']", "", sources)
    return joined.replace('\\"', '"') + "".join(map(os.strerror, _SYSTEM_ERRORS))


_SYSTEM_ERRORS = (errno.ENOENT, errno.EACCES, errno.ENOSPC, errno.EFBIG, errno.EISDIR)


@pytest.mark.parametrize("table", [german_core.CORE])
def test_what_the_package_says_is_said_as_in_the_table(table: dict[str, str]) -> None:
    said = _said_by_the_package()
    parts = {
        part.strip(" :;")
        for text in table
        for piece in re.split(r"\{\w+\}", text)
        for part in piece.split("; ")
    }
    assert len(parts) > 40
    assert [part for part in sorted(parts) if part not in said] == []


@pytest.mark.parametrize("language", LANGUAGES)
def test_nothing_is_in_the_table_that_is_not_shown(language: str) -> None:
    shown = {text for path in SHOWN for _, text in texts_in(path)}
    shown |= {text for path in DEFINED for _, text in definitions_in(path)}
    written = {template for path in _written() for template in _templates_in(path)}
    left = set(LANGUAGES[language]) - shown - set(known_texts()) - set(german_core.CORE)
    left = {text for text in left if re.sub(r"\{\w+\}", "{}", text) not in written}
    assert left <= {"and", "X", "Y", "Z", "None"}


@pytest.mark.parametrize("language", LANGUAGES)
def test_what_is_filled_in_is_the_same(language: str) -> None:
    for text, said in LANGUAGES[language].items():
        assert sorted(re.findall(r"\{\w+\}", text)) == sorted(re.findall(r"\{\w+\}", said)), text
        assert said.strip() == said
        assert said, text


def test_no_words_are_put_together_in_f_strings() -> None:
    """Languages order words differently: sentences are templates in the table."""
    units = {"ms", "min", "Hz", "MB", "GB", "SPARSEMOCAP", "FH", "sparse", "mocap", "import"}
    for path in SHOWN:
        tree = ast.parse(path.read_text(encoding="utf-8"))
        raised = {id(p) for n in ast.walk(tree) if isinstance(n, ast.Raise) for p in ast.walk(n)}
        for node in ast.walk(tree):
            for part in node.values if isinstance(node, ast.JoinedStr) else ():
                if isinstance(part, ast.Constant) and id(part) not in raised:
                    words = set(re.findall(r"[A-Za-z]{2,}", str(part.value))) - units
                    assert words == set(), f"{path.name}:{node.lineno}: {words}"


def test_descriptions_are_no_longer_than_blender_keeps() -> None:
    """What is longer is cut, and then not found in the table."""
    for path in DEFINED:
        for line, text in definitions_in(path):
            assert len(text.encode()) < 240, f"{path.name}:{line}"


def test_texts_are_found() -> None:
    assert dict(texts_in(ADDON / "ui" / "help.py"))
    assert "Open Log" in dict(texts_in(ADDON / "ui" / "help.py")).values()
    assert "Try It" in dict(definitions_in(ADDON / "ops" / "try_it.py")).values()
