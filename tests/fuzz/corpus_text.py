# SPDX-License-Identifier: GPL-3.0-or-later
"""What the corpora of the text formats share: ways to change a good file."""

from __future__ import annotations

from collections.abc import Iterator

NUMBERS = {
    "nan": "nan", "inf": "inf", "minus_inf": "-inf", "comma": "1,5", "plus": "+1.5",
    "tiny": "1e-400", "huge": "1e400", "large": "1e30", "hex": "0x1A", "two_minus": "--5",
    "no_leading_zero": "-.5", "no_digits_after": "5.", "three_digit_exponent": "6e-014",
    "only_point": ".", "only_exponent": "1e", "word": "x", "ind": "-1.#IND", "overflow": "9" * 400,
    "many_zeros": "0." + "0" * 300 + "1", "whole_turns": "1000080",
}  # fmt: skip


def replaced(text: str, old: str, new: str) -> str:
    """The text with its first `old` changed, which must be there."""
    assert old in text, old
    return text.replace(old, new, 1)


def changed(text: str, changes: dict[str, tuple[str, ...]]) -> dict[str, bytes]:
    """A file for each entry: name -> (old, new, old, new, ...)."""
    files = {}
    for name, pairs in changes.items():
        result = text
        for old, new in zip(pairs[::2], pairs[1::2], strict=True):
            result = replaced(result, old, new)
        files[name] = result.encode("utf-8")
    return files


def with_number(text: str, place: str, old: str, prefix: str) -> dict[str, bytes]:
    """The number `old` within the words `place` in every form of NUMBERS."""
    return {
        f"{prefix}_{name}": replaced(text, place, replaced(place, old, number)).encode()
        for name, number in NUMBERS.items()
    }


def line_ends(text: str) -> dict[str, bytes]:
    plain = text.encode()
    return {
        "whole": plain,
        "crlf": plain.replace(b"\n", b"\r\n"),
        "cr": plain.replace(b"\n", b"\r"),
        "mixed_line_ends": plain.replace(b"\n", b"\r\n", 5).replace(b"\n", b"\r", 9),
        "utf8_mark": b"\xef\xbb\xbf" + plain,
        "utf16": text.encode("utf-16"),
        "utf16_without_mark": text.encode("utf-16-le"),
        "blanks_at_line_ends": plain.replace(b"\n", b" \t\n"),
        "empty_lines": plain.replace(b"\n", b"\n\n \n"),
        "no_final_newline": plain.rstrip(b"\n"),
        "nul": plain[:40] + b"\0" + plain[40:],
        "upper_case": plain.upper(),
        "lower_case": plain.lower(),
        "one_line": plain.replace(b"\n", b" "),
        "form_feeds": plain.replace(b" ", b"\f\v"),
        "empty": b"",
        "blank": b" \n\t\r\n",
        "twice": plain + plain,
        "backwards": b"\n".join(reversed(plain.split(b"\n"))),
    }


def cut(text: str, parts: int) -> Iterator[tuple[str, bytes]]:
    """The text cut at so many places."""
    for part in range(1, parts):
        yield f"cut_{part:02}", text[: len(text) * part // parts].encode()
