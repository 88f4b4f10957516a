# SPDX-License-Identifier: GPL-3.0-or-later
"""The methods of reconstruction, as menus show them and as the core asks for them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from .core import core, missing_reason
from .errors import InputError
from .file_cache import FileCache

_ALTERNATIVES = "alternatives"  # the option

Items = list[tuple[str, str, str]]
"""Identifiers, labels and descriptions."""


@dataclass(frozen=True)
class MethodChoice:
    """A method with its settings; empty: the default."""

    method: str = ""
    preset: str = ""
    options: tuple[tuple[str, str], ...] = ()
    model: str = ""
    """The file of the trained model, for methods that need one."""

    def arguments(self) -> dict[str, Any]:
        """The arguments of the core's reconstruct() and LiveReconstructor.

        Raises InputError for a method that needs a model without one, and what is wrong with it.
        """
        found = {
            "method": self.method or None,
            "preset": self.preset or None,
            "options": dict(self.options),
        }
        if needs_model(self.method):
            found["model"] = models.get(self.model)
        return found


models: FileCache[Any] = FileCache("trained model", lambda path: core().read_model(path))


def choice_of(method: str, preset: str, options: str, model: str = "") -> tuple[MethodChoice, str]:
    """The choice, and a warning if a name has changed; options: "KEY=VALUE, KEY=VALUE".

    Raises InputError for text that is not of that form.
    """
    new_method, new_preset, renamed = core().methods.renamed_preset(method or None, preset or None)
    parsed = parsed_options(options)
    return MethodChoice(new_method or "", new_preset or "", parsed, model), renamed


def parsed_options(text: str) -> tuple[tuple[str, str], ...]:
    """The options in "KEY=VALUE, KEY=VALUE". Raises InputError."""
    pairs = []
    for part in filter(None, (part.strip() for part in text.split(","))):
        name, equals, value = (piece.strip() for piece in part.partition("="))
        if not (name and equals and value):
            raise InputError(f'"{part}" is not NAME=VALUE, for example: num_paths=128')
        pairs.append((name, value))
    return tuple(pairs)


def written_options(pairs: list[tuple[str, str]]) -> str:
    """The options as parsed_options reads them."""
    return ", ".join(f"{name}={value}" for name, value in pairs)


def method_items() -> Items:
    """All methods, the default first."""
    return [(method.name, method.title, method.summary) for method in _methods()]


def preset_items(method: str) -> Items:
    """The presets of a method, the default first."""
    return [
        (preset.name, preset.name.replace("_", " ").capitalize(), preset.help)
        for known in _methods()
        if known.name == method
        for preset in known.presets
    ]


def option_items(method: str) -> Items:
    """The options of a method; descriptions say what is possible."""
    return [
        (option.name, option.name, f"{option.help} ({option.possible_values})")
        for known in _methods()
        if known.name == method
        for option in known.options
    ]


def default_of(method: str, option: str) -> str:
    """The default value of an option as text."""
    for known in _methods():
        for candidate in known.options:
            if (known.name, candidate.name) == (method, option):
                return str(candidate.default)
    return ""


def has_alternatives(method: str) -> bool:
    """Whether the method (empty: the default) can offer alternatives of a take."""
    known = [one for one in _methods() if one.name == method] or list(_methods()[:1])
    return any(option.name == _ALTERNATIVES for one in known for option in one.options)


def with_alternatives(choice: MethodChoice) -> MethodChoice:
    """The choice with as many alternatives as there can be, unless it says how many."""
    if not has_alternatives(choice.method) or _ALTERNATIVES in dict(choice.options):
        return choice
    return replace(choice, options=(*choice.options, (_ALTERNATIVES, "2")))


def has_best_quality(method: str) -> bool:
    """Whether the method (empty: the default) can use the whole take for every frame."""
    known_methods = _methods()
    if not method:
        return bool(known_methods) and bool(known_methods[0].works_on_whole_takes)
    return any(known.works_on_whole_takes for known in known_methods if known.name == method)


def needs_model(method: str) -> bool:
    """Whether the method (empty: the default) needs a trained model."""
    return "model" in _needs(method)


def needs_database(method: str) -> bool:
    """Whether the method (empty: the default) needs a motion database."""
    return "database" in _needs(method)


def missing_file(method: str, database: str, model: str) -> str:
    """What has to be chosen before the method can be used; empty when all is there."""
    if needs_database(method) and not database:
        return "Choose a motion database first"
    if needs_model(method) and not model:
        return "Train or open a model first"
    return ""


def _needs(method: str) -> tuple[str, ...]:
    known = _methods()
    if not method:
        return tuple(known[0].needs) if known else ("database",)
    return next((tuple(one.needs) for one in known if one.name == method), ("database",))


def _methods() -> tuple[Any, ...]:
    return () if missing_reason() else core().methods.methods()
