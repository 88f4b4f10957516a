# SPDX-License-Identifier: GPL-3.0-or-later
"""The methods of reconstruction: what each needs, and what can be set."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

from ._core import ConfigError, method_infos

__all__ = [
    "DEFAULT_METHOD",
    "Experiment",
    "MethodInfo",
    "OptionInfo",
    "PresetInfo",
    "Variant",
    "method_info",
    "methods",
    "option_values",
    "renamed_preset",
]


@dataclass(frozen=True)
class PresetInfo:
    """Settings that belong together, by a name."""

    name: str
    help: str


@dataclass(frozen=True)
class OptionInfo:
    """A setting of a method."""

    name: str
    kind: str
    """"number", "integer", "flag" or "choice"."""
    help: str
    default: str
    """As it would be written; live and best quality may differ from each other."""
    lowest: float | None = None
    highest: float | None = None
    choices: tuple[str, ...] = ()

    @property
    def possible_values(self) -> str:
        """What it can be set to, in words."""
        if self.kind == "flag":
            return "true or false"
        if self.choices:
            return ", ".join(self.choices)
        return f"{self.lowest:g} to {self.highest:g}"


@dataclass(frozen=True)
class Variant:
    """One of the ways that an experiment compares."""

    label: str
    options: dict[str, str]
    sensors: dict[str, list[str]]
    """By site, with the channels that they give; none: those of the evaluation."""
    method: str = ""
    """Empty: the one whose experiment it is."""
    in_best_quality: bool = False
    """Of methods that work live as well."""
    knows_all_clips: bool = False
    """A database of all clips but the tests, not of the training clips alone."""


@dataclass(frozen=True)
class Experiment:
    """A comparison that a paper makes."""

    name: str
    help: str
    variants: tuple[Variant, ...]
    pairs: tuple[tuple[str, str], ...]
    """Patterns on the names of training and test clips; none: the evaluation's scenario."""
    error: str
    """"position_cm" or "joint_angle_deg"."""


@dataclass(frozen=True)
class MethodInfo:
    """What can be known of a method before it is used."""

    name: str
    title: str
    summary: str
    paper: str
    """Empty for the project's own method."""
    presets: tuple[PresetInfo, ...]
    """The default first."""
    options: tuple[OptionInfo, ...]
    needs: tuple[str, ...]
    """Of "database", "model" and "body"."""
    required_channels: tuple[str, ...]
    optional_channels: tuple[str, ...]
    one_channel_of: tuple[str, ...]
    """Every sensor gives at least one of these; empty: that is not asked for."""
    fewest_sensors: int
    most_sensors: int
    works_live: bool
    works_on_whole_takes: bool
    can_be_trained: bool
    experiments: tuple[Experiment, ...]

    def can_use(self, channels: Collection[str]) -> bool:
        """Whether sensors that give these channels are enough."""
        asked = self.one_channel_of
        return set(self.required_channels) <= set(channels) and (
            not asked or not set(asked).isdisjoint(channels)
        )


@cache
def methods() -> tuple[MethodInfo, ...]:
    """Returns all methods, the default first."""
    return tuple(_method(told) for told in method_infos())


def method_info(name: str) -> MethodInfo:
    """Returns a method by its name. Raises ConfigError naming the known ones."""
    for method in methods():
        if method.name == name:
            return method
    known = ", ".join(method.name for method in methods())
    raise ConfigError(f"unknown method '{name}'; known are {known}")


DEFAULT_METHOD = "path_regression"


def option_values(options: Mapping[str, Any]) -> dict[str, str]:
    """Returns options as the core reads them: True as "true", 0.5 as "0.5"."""
    return {
        name: str(value).lower() if isinstance(value, bool) else str(value)
        for name, value in options.items()
    }


def renamed_preset(method: str | None, preset: str | None) -> tuple[str | None, str | None, str]:
    """Returns method and preset as they are called now, and what to write instead, if anything.

    The method of the paper was a preset named "paper" of the only method, tautges2011, whose
    preset "default" is now the method path_regression.
    """
    if preset == "paper" and method in (None, DEFAULT_METHOD):
        return "tautges2011", None, "--preset paper is now --method tautges2011"
    if preset == "default" and method == "tautges2011":
        return (
            DEFAULT_METHOD,
            None,
            ("--method tautges2011 --preset default is now --method path_regression"),
        )
    return method, preset, ""


def _method(told: dict[str, Any]) -> MethodInfo:
    return MethodInfo(
        name=told["name"],
        title=told["title"],
        summary=told["summary"],
        paper=told["paper"],
        presets=tuple(PresetInfo(**preset) for preset in told["presets"]),
        options=tuple(
            OptionInfo(**{**option, "choices": tuple(option.get("choices", ()))})
            for option in told["options"]
        ),
        needs=tuple(told["needs"]),
        required_channels=tuple(told["channels"]["required"]),
        optional_channels=tuple(told["channels"]["optional"]),
        one_channel_of=tuple(told["channels"]["one_of"]),
        fewest_sensors=told["sensors"]["fewest"],
        most_sensors=told["sensors"]["most"],
        works_live=told["works_live"],
        works_on_whole_takes=told["works_on_whole_takes"],
        can_be_trained=told["can_be_trained"],
        experiments=tuple(
            Experiment(
                experiment["name"],
                experiment["help"],
                tuple(Variant(**variant) for variant in experiment["variants"]),
                tuple(experiment["pairs"]),
                experiment["error"],
            )
            for experiment in told["experiments"]
        ),
    )
