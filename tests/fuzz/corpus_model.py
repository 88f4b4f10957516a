# SPDX-License-Identifier: GPL-3.0-or-later
"""The corpus of models: safetensors files of few numbers, checksums right and wrong."""

from __future__ import annotations

import json
import struct
from typing import Any

from corpus_database import digest, encoded

Json = dict[str, Any]
Tensors = dict[str, tuple[str, list[int], bytes]]
SIZES = {
    "BOOL": 1, "U8": 1, "I8": 1, "F8_E5M2": 1, "F8_E4M3": 1, "F8_E8M0": 1, "U16": 2, "I16": 2,
    "F16": 2, "BF16": 2, "U32": 4, "I32": 4, "F32": 4, "U64": 8, "I64": 8, "F64": 8, "C64": 8,
}  # fmt: skip


def good_tensors() -> Tensors:
    """One of each type that methods use, the largest elements first."""
    return {
        "W": ("F64", [2, 3], struct.pack("<6d", *range(6))),
        "counts": ("I64", [2], struct.pack("<2q", -(2**40), 7)),
        "bias": ("F32", [3], struct.pack("<3f", 0.5, -1.5, 1e-30)),
        "parents": ("I32", [2, 1], struct.pack("<2i", -1, 0)),
        "is_left": ("U8", [5], bytes(range(5))),
    }


def good_metadata() -> dict[str, str]:
    return {
        "format": "sparse_mocap_model", "format_version": "1", "method": "liu2011",
        "model_version": "2", "metadata": json.dumps({"made of": "walks"}),
    }  # fmt: skip


def header_of(metadata: dict[str, str], tensors: Tensors) -> Json:
    sums = {name: digest(content) for name, (_, _, content) in tensors.items()}
    whole = {"checksums": json.dumps(sums)} | metadata
    text = "".join(f"{key}\0{whole[key]}\0" for key in sorted(whole))
    header: Json = {"__metadata__": whole | {"metadata_checksum": digest(text.encode())}}
    begin = 0
    for name, (kind, shape, content) in tensors.items():
        end = begin + len(content)
        header[name] = {"dtype": kind, "shape": shape, "data_offsets": [begin, end]}
        begin = end
    return header


def file_of(metadata: dict[str, str], tensors: Tensors) -> bytes:
    data = b"".join(content for _, _, content in tensors.values())
    return encoded(header_of(metadata, tensors), data)


def damaged_metadata() -> dict[str, bytes]:
    """Claims that are checksummed but false, and odd ones that are true."""
    good, tensors = good_metadata(), good_tensors()
    files = {f"without_{key}": {k: v for k, v in good.items() if k != key} for key in good}
    texts = {
        "format": ["other", "", "sparse_mocap_database", "sparse_mocap_model\n"],
        "format_version": ["0", "2", "-1", "one", "", "1.0", "99999999999999999999", "1\n2"],
        "method": ["", "Liu2011", "2011", "a b", "a/b", "\u00e9", "x", "_", "a" * 256, "a\n"],
        "model_version": ["0", "-1", "1.5", "", "x", "1000000", "1000001", "9" * 30, " 1", "+1"],
        "metadata": [
            "", "[]", "{}", "null", "5", '"text"', '{"a":1}', '{"a":null}', '{"a":{"b":"c"}}',
            '{"a":"1","a":"2"}', '{"a":"\\ud800"}', '{"":""}', '{"a":"\\n\\u0000"}', "[" * 500,
            json.dumps({str(number): "v" for number in range(50)}),
        ],
        "checksums": ["", "[]", "{}", "null", '{"W":"0"}', '{"W":5}', '{"none":"0"}', "{" * 300],
        "a_later_key": ["a value"],
    }  # fmt: skip
    for key, values in texts.items():
        files |= {f"{key}_{index}": good | {key: value} for index, value in enumerate(values)}
    return {name: file_of(metadata, tensors) for name, metadata in files.items()}


def odd_tensors() -> dict[str, bytes]:
    metadata, good = good_metadata(), good_tensors()
    files: dict[str, Tensors] = {
        f"type_{kind}": {"x": (kind, [2], bytes(2 * size))} for kind, size in SIZES.items()
    }
    files |= {f"no_type_{kind}": {"x": (kind, [2], bytes(2))} for kind in ("F4", "f32", "", "U128")}
    odd_values = {
        "W": (b"\0\0\0\0\0\0\xf8\x7f", b"\0\0\0\0\0\0\xf0\xff"),
        "bias": (b"\0\0\xc0\x7f", b"\0\0\x80\xff"),
    }
    for name, (nan, infinity) in odd_values.items():
        kind, shape, content = good[name]
        for text, value in (("nan", nan), ("inf", infinity)):
            changed = (kind, shape, value + content[len(value) :])
            files[f"{text}_in_{name}"] = good | {name: changed}
    shapes: dict[str, tuple[list[int], int]] = {
        "scalar": ([], 1), "none": ([0], 0), "none_of_many": ([0, 10**9], 0), "deep": ([1] * 20, 1),
        "wide": ([2, 2, 2], 8), "more_than_int": ([2**63, 0], 0), "short": ([3], 2),
        "long": ([1], 2),
    }  # fmt: skip
    files |= {
        f"shape_{name}": {"x": ("F32", shape, bytes(4 * count))}
        for name, (shape, count) in shapes.items()
    }
    names = ["", "a b", "a/b", "\u00e9", "n" * 255, "n" * 256, "line\nbreak", "models/liu2011/W"]
    files |= {f"name_{i}": {name: ("U8", [1], b"\1")} for i, name in enumerate(names)}
    files["no_tensors"] = {}
    files["many_tensors"] = {f"t{i}": ("U8", [0], b"") for i in range(20)}
    files["order_of_sizes_turned"] = dict(reversed(good.items()))
    return {name: file_of(metadata, tensors) for name, tensors in files.items()}


def damaged_headers() -> dict[str, bytes]:
    tensors = good_tensors()
    data = b"".join(content for _, _, content in tensors.values())
    good = header_of(good_metadata(), tensors)
    entries: dict[str, Json] = {
        "overlap": {"data_offsets": [40, 56]}, "hole": {"data_offsets": [52, 68]},
        "backwards": {"data_offsets": [64, 48]}, "beyond": {"data_offsets": [48, 10**9]},
        "wraps": {"data_offsets": [2**64 - 4, 64]}, "too_large": {"shape": [2**33, 2**33]},
        "negative": {"shape": [-2]}, "fraction": {"shape": [2.0]}, "text": {"shape": "2"},
        "f64": {"dtype": "F64"}, "i32": {"dtype": "I32"}, "no_dtype": {"dtype": None},
        "no_shape": {"shape": None}, "number": {"shape": 2}, "one_offset": {"data_offsets": [48]},
        "three_offsets": {"data_offsets": [48, 64, 64]},
    }  # fmt: skip
    files = {
        f"array_{name}": encoded(good | {"counts": good["counts"] | change}, data)
        for name, change in entries.items()
    }
    text = json.dumps(good)
    return files | {
        "header_not_json": encoded(text[:-1], data),
        "header_a_list": encoded("[]", b""),
        "header_twice_a_key": encoded(text[:-1] + ',"W":' + json.dumps(good["W"]) + "}", data),
        "header_with_nul": encoded(text + "\0", data),
        "header_in_latin1": encoded(good, data).replace(b"liu2011", b"li\xef2011"),
        "header_longer_than_file": encoded(text, data, 10**6),
        "header_of_no_bytes": encoded(text, data, 0),
        "header_of_all_bits": encoded(text, data, 2**64 - 1),
        "metadata_a_number": encoded(good | {"__metadata__": 5}, data),
        "metadata_of_numbers": encoded(good | {"__metadata__": {"format": 5}}, data),
        "no_metadata": encoded({k: v for k, v in good.items() if k != "__metadata__"}, data),
        "bytes_behind": encoded(good, data + b"\0\0\0\0"),
        "checksums_wrong": encoded(good, data[:-3] + b"\7" + data[-2:]),
    }


def model_files() -> dict[str, bytes]:
    whole = file_of(good_metadata(), good_tensors())
    files = {"whole": whole, "empty": b"", "short": b"\1\2\3\4\5\6\7", "zip": b"PK\3\4" + bytes(60)}
    files |= {f"cut_{part:02}": whole[: len(whole) * part // 12] for part in range(1, 12)}
    return files | damaged_metadata() | odd_tensors() | damaged_headers()
