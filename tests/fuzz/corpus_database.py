# SPDX-License-Identifier: GPL-3.0-or-later
"""The corpus of motion databases: safetensors files of few frames, checksums right and wrong."""

from __future__ import annotations

import json
import struct
from typing import Any

import xxhash
from sparse_mocap import standard_joint_names

COLUMNS = {
    "angles": 43, "positions": 63, "root_motion": 4, "contacts": 2, "specific_force_pivot": 3,
    "specific_force_end": 3, "angular_velocity": 3, "up": 3, "clip_index": 1,
}  # fmt: skip
Json = dict[str, Any]


def digest(content: bytes) -> str:
    return xxhash.xxh3_64_hexdigest(content)


def clip(begin: int, end: int, **changes: object) -> Json:
    entry: Json = {
        "name": f"c{begin}", "actor": "a", "class": "k", "source": "s", "source_hash": "0",
        "mirrored": False, "reversed": False, "tempo": 1.0, "begin": begin, "end": end,
    }  # fmt: skip
    return entry | changes


def arrays_of(clips: list[int]) -> dict[str, bytes]:
    """Frames of numbers that are all different; clips: their lengths."""
    frames = sum(clips)
    owners = [index for index, length in enumerate(clips) for _ in range(length)]
    arrays = {}
    for name, columns in COLUMNS.items():
        values = [0.01 * value for value in range(frames * columns)]
        if name == "up":
            values = [0.0, 1.0, 0.0] * frames
        arrays[name] = (
            struct.pack(f"<{frames}i", *owners)
            if name == "clip_index"
            else struct.pack(f"<{len(values)}f", *values)
        )
    return arrays


def metadata_of(clips: list[int]) -> dict[str, str]:
    ends = [sum(clips[: index + 1]) for index in range(len(clips))]
    joints = [{"name": name, "bone_m": [0, -0.1, 0]} for name in standard_joint_names()]
    entries = [clip(end - length, end) for end, length in zip(ends, clips, strict=True)]
    return {
        "format": "sparse_mocap_database", "format_version": "1", "build": "{}", "rate_hz": "25.0",
        "sites": '["left_wrist"]', "skeleton": json.dumps(joints), "clips": json.dumps(entries),
    }  # fmt: skip


def encoded(header: Json | str, data: bytes, size: int | None = None) -> bytes:
    text = (header if isinstance(header, str) else json.dumps(header)).encode()
    text += b" " * (-(8 + len(text)) % 64)
    return struct.pack("<Q", len(text) if size is None else size) + text + data


def sealed(metadata: dict[str, str], arrays: dict[str, bytes]) -> dict[str, str]:
    sums = {name: digest(content) for name, content in arrays.items()}
    whole = {key: metadata[key] for key in metadata} | {"checksums": json.dumps(sums)}
    text = "".join(f"{key}\0{whole[key]}\0" for key in sorted(whole))
    return whole | {"metadata_checksum": digest(text.encode())}


def header_of(metadata: dict[str, str], arrays: dict[str, bytes]) -> Json:
    header: Json = {"__metadata__": sealed(metadata, arrays)}
    begin = 0
    for name, content in arrays.items():
        columns = COLUMNS.get(name, 1)
        header[name] = {
            "dtype": "I32" if name == "clip_index" else "F32",
            "shape": [len(content) // 4 // columns, columns],
            "data_offsets": [begin, begin + len(content)],
        }
        begin += len(content)
    return header


def file_of(metadata: dict[str, str], arrays: dict[str, bytes]) -> bytes:
    return encoded(header_of(metadata, arrays), b"".join(arrays.values()))


def damaged_metadata() -> dict[str, bytes]:
    """Claims that are checksummed but false."""
    good, arrays = metadata_of([1]), arrays_of([1])
    files = {f"without_{key}": {k: v for k, v in good.items() if k != key} for key in good}
    joints = json.loads(good["skeleton"])
    texts = {
        "format": ["other", ""],
        "format_version": ["0", "2", "one"],
        "rate_hz": ["0", "1e9", "nan", "-25", '"25"', "[]", ""],
        "sites": ["[]", "{}", "[1]", '["a","b"]', '["\\ud800"]', "null"],
        "skeleton": [
            "[]", json.dumps(joints[1:]), json.dumps(joints[::-1]),
            json.dumps([{**joint, "bone_m": [0, 0]} for joint in joints]),
            json.dumps([{**joint, "bone_m": [1e9, 0, 0]} for joint in joints]),
            json.dumps([{**joint, "bone_m": [0, 0, 0]} for joint in joints]),
            json.dumps([{**joint, "bone_m": "no"} for joint in joints]),
            "[" * 500,
        ],
        "clips": [
            "[]", "{}", "[1]", json.dumps([clip(0, 2)]), json.dumps([clip(0, 0)]),
            json.dumps([clip(1, 1)]), json.dumps([clip(0, -1)]), json.dumps([clip(0, 2**40)]),
            json.dumps([clip(0, 1), clip(1, 2)]), json.dumps([clip(0, 1, tempo="fast")]),
            json.dumps([clip(0, 1, tempo=-1.0)]), json.dumps([clip(0, 1, tempo=0.0)]),
            json.dumps([clip(0, 1, mirrored=1)]), json.dumps([clip(0, 1, name=None)]),
            json.dumps([clip(0, 1) | {"end": 1.9}]),
            json.dumps([clip(0, 1, reversed=True, mirrored=True, tempo=1.25)]),
        ],
        "build": ["", "no JSON", "{" * 300],
    }  # fmt: skip
    for key, values in texts.items():
        files |= {f"{key}_{index}": good | {key: value} for index, value in enumerate(values)}
    return {name: file_of(metadata, arrays) for name, metadata in files.items()}


def damaged_arrays() -> dict[str, bytes]:
    metadata, good = metadata_of([1]), arrays_of([1])
    files = {f"no_{name}": {n: a for n, a in good.items() if n != name} for name in good}
    files |= {f"empty_{name}": good | {name: b""} for name in ("angles", "clip_index")}
    files |= {f"nan_in_{n}": good | {n: b"\0\0\xc0\x7f" + good[n][4:]} for n in list(good)[:8]}
    files |= {f"inf_in_{n}": good | {n: b"\0\0\x80\xff" + good[n][4:]} for n in ("angles", "up")}
    files["up_not_of_unit_length"] = good | {"up": struct.pack("<3f", 0.0, 1.1, 0.0)}
    files["longer_angles"] = good | {"angles": good["angles"] * 2}
    files["clip_index_of_none"] = good | {"clip_index": struct.pack("<i", -1)}
    files["clip_index_beyond"] = good | {"clip_index": struct.pack("<i", 2**31 - 1)}
    files["another_array"] = good | {"spare": b"\1\2\3\4"}
    files["no_arrays"] = {}
    return {name: file_of(metadata, arrays) for name, arrays in files.items()}


def with_models() -> dict[str, bytes]:
    """Models and what other programs put into a database, sound and not."""
    metadata, arrays = metadata_of([1]), arrays_of([1])
    entry = {"version": 1, "metadata": {"made of": "walks"}}
    tensor = {"models/a/W": struct.pack("<2f", 1.0, 2.0)}
    good = metadata | {"models": json.dumps({"a": entry})}
    lists = [
        "", "[]", "{}", "null", "[" * 300, '{"a":1}', '{"a":{}}', '{"A":{}}', '{"a/b":{}}',
        '{"a":{},"a":{}}', json.dumps({"b": entry}), json.dumps({"a": entry, "b": entry}),
        json.dumps({"a": entry | {"version": 0}}), json.dumps({"a": entry | {"version": "1"}}),
        json.dumps({"a": entry | {"version": 2**40}}), json.dumps({"a": entry | {"version": 1.5}}),
        json.dumps({"a": entry | {"metadata": {"x": 1}}}), json.dumps({"a": {"version": 1}}),
        json.dumps({"a": entry | {"a later key": [1]}}),
    ]  # fmt: skip
    files = {
        "model": file_of(good, arrays | tensor),
        "model_before_the_rows": file_of(good, tensor | arrays),
        "model_without_tensors": file_of(good, arrays),
        "model_with_nan": file_of(good, arrays | {"models/a/W": b"\0\0\xc0\x7f"}),
        "model_without_name": file_of(good, arrays | {"models/a/": tensor["models/a/W"]}),
        "model_not_listed": file_of(metadata, arrays | tensor),
        "further_metadata": file_of(metadata | {"a later key": "a value"}, arrays),
    }
    for index, text in enumerate(lists):
        files[f"models_{index}"] = file_of(metadata | {"models": text}, arrays | tensor)
    for name in ("spare", "models/a/W", "up"):  # not in the checksums
        header = header_of(good, {n: a for n, a in arrays.items() if n != name})
        begin = sum(len(a) for n, a in arrays.items() if n != name)
        content = arrays.get(name, b"\1\2\3\4")
        header[name] = {
            "dtype": "F32", "shape": [1, len(content) // 4],
            "data_offsets": [begin, begin + len(content)],
        }  # fmt: skip
        data = b"".join(a for n, a in arrays.items() if n != name) + content
        files[f"without_checksum_{name.replace('/', '_')}"] = encoded(header, data)
    return files


def damaged_headers() -> dict[str, bytes]:
    arrays = arrays_of([1])
    data = b"".join(arrays.values())
    good = header_of(metadata_of([1]), arrays)
    files = {}
    entries: dict[str, Json] = {
        "overlap": {"data_offsets": [0, 252]}, "hole": {"data_offsets": [176, 424]},
        "backwards": {"data_offsets": [424, 172]}, "beyond": {"data_offsets": [172, 10**9]},
        "wraps": {"data_offsets": [2**64 - 4, 252]}, "too_large": {"shape": [2**33, 2**33]},
        "negative": {"shape": [-1, -63]}, "flat": {"shape": [63]}, "cube": {"shape": [1, 63, 1]},
        "turned": {"shape": [63, 1]}, "fraction": {"shape": [0.5, 126]}, "f64": {"dtype": "F64"},
        "i32": {"dtype": "I32"}, "no_dtype": {"dtype": None}, "no_shape": {"shape": None},
        "three_offsets": {"data_offsets": [172, 300, 424]},
    }  # fmt: skip
    for name, change in entries.items():
        files[f"array_{name}"] = encoded(good | {"positions": good["positions"] | change}, data)
    text = json.dumps(good)
    files |= {
        "header_not_json": encoded(text[:-1], data),
        "header_a_list": encoded("[]", b""),
        "header_twice_a_key": encoded(text[:-1] + ',"up":' + json.dumps(good["up"]) + "}", data),
        "header_with_nul": encoded(text + "\0", data),
        "header_in_latin1": encoded(good, data).replace(b"left_wrist", b"left_wr\xefst"),
        "header_longer_than_file": encoded(text, data, 10**6),
        "header_of_no_bytes": encoded(text, data, 0),
        "header_of_all_bits": encoded(text, data, 2**64 - 1),
        "header_deep": encoded("[" * 2000, b""),
        "metadata_a_number": encoded(good | {"__metadata__": 5}, data),
        "metadata_of_numbers": encoded(good | {"__metadata__": {"format": 5}}, data),
        "bytes_behind": encoded(good, data + b"\0\0\0\0"),
        "checksums_wrong": encoded(good, data[:-5] + b"\1" + data[-4:]),
    }
    return files


# --- Version 2 -----------------------------------------------------------------------------------

SITE_ARRAYS = ("specific_force_pivot", "specific_force_end", "angular_velocity", "up")
PACKED = {"angles": 43, "positions": 63} | {f"sites/head/{name}": 3 for name in SITE_ARRAYS}
TYPES = {"I16": 2, "F32": 4, "U8": 1}
Arrays = dict[str, tuple[str, int, bytes]]


def second_metadata(clips: list[int]) -> dict[str, str]:
    metadata = metadata_of(clips) | {"format_version": "2", "sites": '["head"]'}
    compact = json.dumps(json.loads(metadata["skeleton"]), separators=(",", ":"))
    return metadata | {"skeleton": compact}


def second_arrays(clips: list[int]) -> Arrays:
    """Element type, columns and content of each array; clips: their lengths."""
    frames = sum(clips)
    scales = struct.pack(f"<{len(clips)}f", *[2.0**-14] * len(clips))
    arrays: Arrays = {
        "root_motion": ("F32", 4, struct.pack(f"<{4 * frames}f", *[0.5] * (4 * frames)))
    }
    arrays |= {f"{name}/scale": ("F32", 1, scales) for name in PACKED}
    for name, columns in PACKED.items():
        values = [(7 * value) % 40000 - 20000 for value in range(frames * columns)]
        if name.endswith("/up"):
            values = [0, 2**14, 0] * frames
        arrays[name] = ("I16", columns, struct.pack(f"<{len(values)}h", *values))
    return arrays | {"contacts": ("U8", 2, bytes([1, 0] * frames))}


def second_file(metadata: dict[str, str], arrays: Arrays) -> bytes:
    sums = {name: content for name, (_, _, content) in arrays.items()}
    header: Json = {"__metadata__": sealed(metadata, sums)}
    begin = 0
    for name, (kind, columns, content) in arrays.items():
        header[name] = {
            "dtype": kind, "shape": [len(content) // TYPES[kind] // columns, columns],
            "data_offsets": [begin, begin + len(content)],
        }  # fmt: skip
        begin += len(content)
    return encoded(json.dumps(header, separators=(",", ":")), b"".join(sums.values()))


def second_files() -> dict[str, bytes]:
    metadata = second_metadata([1])
    good = second_arrays([1])
    files = {f"no_{name}": {n: a for n, a in good.items() if n != name} for name in good}
    for name in PACKED:
        for kind, scale in (("nan", float("nan")), ("zero", 0.0), ("minus", -1.0), ("inf", 1e38)):
            changed = struct.pack("<f", scale)
            files[f"{name}_scale_{kind}"] = good | {f"{name}/scale": ("F32", 1, changed)}
    up, root, angles = good["sites/head/up"], good["root_motion"], good["angles"]
    files |= {
        "up_of_no_length": good | {"sites/head/up": (*up[:2], bytes(6))},
        "smallest": good | {"angles": (*angles[:2], b"\0\x80" * 43)},
        "root_nan": good | {"root_motion": (*root[:2], b"\0\0\xc0\x7f" + root[2][4:])},
        "contact_2": good | {"contacts": ("U8", 2, b"\2\0")},
        "two_rows": second_arrays([2]),
        "two_scales": good | {"angles/scale": ("F32", 1, good["angles/scale"][2] * 2)},
        "as_floats": good | {"angles": ("F32", 43, angles[2] * 2)},
        "flat": good | {"angles": ("I16", 1, angles[2])},
        "section": good | {"sections/index/order": ("I16", 1, b"\1\2")},
    }  # fmt: skip
    made = {name: second_file(metadata, arrays) for name, arrays in files.items()}
    listed = {"index": {"version": 1, "rows": "", "metadata": {"leaf": "64"}}}
    lists = ["", "[]", "null", '{"index":1}', '{"In":{}}', '{"index":{}}', json.dumps(listed),
             json.dumps({"index": listed["index"] | {"rows": "0" * 16}}),
             json.dumps({"index": listed["index"] | {"rows": 1}}),
             json.dumps({"index": listed["index"] | {"metadata": [1]}}),
             json.dumps({"index": listed["index"] | {"version": 1.5}})]  # fmt: skip
    for index, text in enumerate(lists):
        made[f"sections_{index}"] = second_file(metadata | {"sections": text}, files["section"])
    two = second_metadata([2, 1])
    made |= {
        "whole": second_file(metadata, good),
        "two_clips": second_file(two, second_arrays([2, 1])),
        "sites_twice": second_file(metadata | {"sites": '["head","head"]'}, good),
        "sites_other": second_file(metadata | {"sites": '["chest"]'}, good),
        "clips_none": second_file(metadata | {"clips": "[]"}, good),
        "clips_many": second_file(metadata | {"clips": json.dumps([clip(0, 2**30)])}, good),
        "clips_far": second_file(
            metadata | {"clips": json.dumps([clip(0, 1), clip(1, 2**31 - 1)])}, good
        ),
        "as_version_1": second_file(metadata | {"format_version": "1"}, good),
    }
    return {f"second_{name.replace('/', '_')}": content for name, content in made.items()}


def database_files() -> dict[str, bytes]:
    whole = file_of(metadata_of([1]), arrays_of([1]))
    files = {
        "whole": whole,
        "two_clips": file_of(metadata_of([1, 1]), arrays_of([1, 1])),
        "empty": b"", "short": b"\1\2\3\4\5\6\7", "zip": b"PK\x03\x04" + b"\0" * 60,
        "pickle": b"\x80\x04\x95\x10\0\0\0\0\0\0\0}\x94.",
        "of_another_format": encoded(
            {"x": {"dtype": "F32", "shape": [0], "data_offsets": [0, 0]}}, b""
        ),
    }  # fmt: skip
    files |= {f"cut_{part:02}": whole[: len(whole) * part // 12] for part in range(1, 12)}
    files |= damaged_metadata() | damaged_arrays() | damaged_headers() | with_models()
    files |= second_files()
    return files
