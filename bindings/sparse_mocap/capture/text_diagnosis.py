# SPDX-License-Identifier: GPL-3.0-or-later
"""Why lines of text give no samples, and which option of text_line makes them."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence

from .. import driver_options

__all__ = ["is_text", "why_no_lines"]

_SEPARATORS = {"comma": ",", "tab": "\t", "semicolon": ";", "space": " "}
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
_COMMA_NUMBER = re.compile(r"[+-]?\d+,\d+")
_LABELLED = re.compile(r"([A-Za-z][^\s=:,;]*)\s*[=:]\s*[+-]?[\d.]")
_BEGINS_WITH_LABEL = re.compile(r"\s*([A-Za-z][^\s:=,;]*(?:[:=]|(?=[\t ])))\s*[+-]?[\d.]")
_LEAST_COLUMNS = 3
_LARGEST_IN_MPS2 = 400.0


def is_text(data: bytes) -> bool:
    """Whether these bytes are lines of text rather than binary messages."""
    printable = sum(byte in b"\t\r\n" or 32 <= byte < 127 for byte in data)
    return bool(data) and printable > 0.95 * len(data)


def why_no_lines(lines: Sequence[str], options: Mapping[str, str]) -> str:
    """Returns why text_line with these options makes no sample of the lines, and what to do."""
    lines = [line.strip("\r\n") for line in lines if line.strip()]
    if not lines:
        return "no complete line has arrived; end each line with println or \\n"
    line, header = lines[-1], next((line for line in lines if _is_header(line)), "")
    said = f"the last line is {_shown(line)}"
    known = {name: default for name, (default, _) in driver_options("text_line").items()}
    settings = {**known, **options}
    if settings["columns"] == "header" and not header:
        return (
            f"{said}, and no header line has arrived; restart the device so that it sends one, or "
            "name the columns with the option columns"
        )
    if header and settings["columns"] != "header":
        return f"a header line arrived, {_shown(header)}; set the option columns=header"
    return f"{said}; {_why(line, settings)}"


def _why(line: str, settings: Mapping[str, str]) -> str:
    prefix, separator = settings["prefix"], _SEPARATORS[settings["separator"]]
    if _is_json(line):
        return (
            "lines of JSON are not read; print the numbers alone, separated by commas: "
            "0.12,0.05,9.81,0,0,0"
        )
    if prefix and not line.startswith(prefix):
        return f"it does not begin with {prefix!r}, the option prefix"
    rest = line.removeprefix(prefix)
    return (
        _why_decimal_commas(rest)
        or _why_labels(rest)
        or _why_separator(rest, separator, settings)
        or _why_columns(rest, separator, settings)
    )


def _why_decimal_commas(line: str) -> str:
    fields = [field for field in re.split(r"[;\t ]+", line.strip()) if field]
    commas = [field for field in fields if _COMMA_NUMBER.fullmatch(field)]
    if len(commas) < _LEAST_COLUMNS or len(commas) + sum(map(_is_number, fields)) < len(fields):
        return ""
    return "its numbers have decimal commas; let the device print decimal points"


def _why_labels(line: str) -> str:
    labels = [match[1] for match in _LABELLED.finditer(line)]
    if len(labels) >= _LEAST_COLUMNS:
        return (
            f"its numbers have labels such as {labels[0]!r}; print the numbers alone, separated by "
            "commas"
        )
    match = _BEGINS_WITH_LABEL.match(line)
    return f"it begins with a label; set the option prefix={match[1]}" if match else ""


def _why_separator(line: str, separator: str, settings: Mapping[str, str]) -> str:
    if _count(line, separator) >= _LEAST_COLUMNS:
        return ""
    for name, other in _SEPARATORS.items():
        if name != settings["separator"] and _count(line, other) >= _LEAST_COLUMNS:
            return f"its numbers are separated by a {name}; set the option separator={name}"
    return ""


def _why_columns(line: str, separator: str, settings: Mapping[str, str]) -> str:
    fields = _split(line, separator)
    columns = settings["columns"].split(",")
    if settings["columns"] != "header" and len(fields) != len(columns):
        many = "too many" if len(fields) > len(columns) else "too few"
        return (
            f"it has {len(fields)} columns, {abs(len(fields) - len(columns))} {many}: expected are "
            f"{settings['columns']}; set the option columns to what the device prints, with 'skip' "
            "for a column that is not needed"
        )
    for column, field in zip(columns, fields, strict=False):
        if column not in ("sensor", "skip", "header") and not _is_number(field):
            return f"{field[:20]!r}, its column {column}, is not a number"
    force = [float(f) for c, f in zip(columns, fields, strict=False) if c in ("ax", "ay", "az")]
    if (
        settings["acceleration_unit"] == "m/s2"
        and force
        and max(map(abs, force)) > _LARGEST_IN_MPS2
    ):
        return "its accelerations look like raw counts; set the option acceleration_unit=raw"
    return "its values are beyond what a sensor measures, or its time or counter stands still"


def _is_json(line: str) -> bool:
    if not line.lstrip().startswith(("{", "[")):
        return False
    try:
        json.loads(line)
    except (ValueError, RecursionError):
        return False
    return True


def _is_header(line: str) -> bool:
    """Whether the line has names instead of numbers, an axis of an accelerometer among them."""
    fields = [field.strip() for field in re.split(r"[,;\t]", line)]
    if len(fields) < _LEAST_COLUMNS or any(map(_is_number, fields)) or set(line) & set("{}:="):
        return False
    axes = [re.sub(r"[^a-z]", "", re.split(r"[(\[]", field.lower())[0]) for field in fields]
    wanted = re.compile(r"(a|acc|accel|acceleration|accelerometer)([xyz])")
    return {match[2] for axis in axes if (match := wanted.fullmatch(axis))} == set("xyz")


def _split(line: str, separator: str) -> list[str]:
    fields = line.split() if separator == " " else line.split(separator)
    return [field.strip() for field in fields]


def _count(line: str, separator: str) -> int:
    return sum(map(_is_number, _split(line, separator)))


def _is_number(text: str) -> bool:
    return _NUMBER.fullmatch(text.strip()) is not None


def _shown(line: str) -> str:
    text = "".join(letter if letter.isprintable() else " " for letter in line)
    return f"'{text[:60]}'" + ("..." if len(text) > 60 else "")
