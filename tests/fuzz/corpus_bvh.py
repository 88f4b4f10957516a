# SPDX-License-Identifier: GPL-3.0-or-later
"""The corpus of BVH files."""

from __future__ import annotations

import itertools

from corpus_text import changed, cut, line_ends, with_number

WALK = """HIERARCHY
ROOT Hips
{
  OFFSET 0 0.9 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Chest
  {
    OFFSET 0 0.3 0.1
    CHANNELS 3 Yrotation Xrotation Zrotation
    End Site
    {
      OFFSET 0 0.25 0
    }
  }
  JOINT Leg
  {
    OFFSET 0.1 -0.05 0
    CHANNELS 3 Xrotation Yrotation Zrotation
    JOINT Shin
    {
      OFFSET 0 -0.42 0
      CHANNELS 1 Xrotation
      End Site
      {
        OFFSET 0 -0.4 0
      }
    }
  }
}
MOTION
Frames: 3
Frame Time: 0.0083333
0 90 0 0 0 0 1 2 3 4 5 6 7
1 90 2 179 -5 10 -170 20 89.9 40 50 60 -7
2 90 4 -179 5 370 1e-5 -2 90 180 -180 720 0
"""
CHEST = "CHANNELS 3 Yrotation Xrotation Zrotation"
SHIN = "CHANNELS 1 Xrotation"
ROW = "0 90 0 0 0 0 1 2 3 4 5 6 7\n"
HEAD = WALK[: WALK.index("MOTION")]

RULES = {
    "brace_on_the_line": ("JOINT Chest\n  {", "JOINT Chest {"),
    "brace_glued": ("JOINT Chest\n  {", "JOINT Chest{"),
    "braces_share_a_line": ("      OFFSET 0 -0.4 0\n      }\n    }\n  }\n}", "OFFSET 0 -0.4 0}}}}"),
    "brace_missing": ("}\nMOTION", "MOTION"),
    "brace_too_many": ("}\nMOTION", "}\n}\nMOTION"),
    "brace_never_opened": ("JOINT Chest\n  {", "JOINT Chest\n"),
    "end_site_with_a_name": ("End Site", "End Site Top of head"),
    "end_without_site": ("End Site\n    {", "End\n    {"),
    "end_site_missing": ("    End Site\n    {\n      OFFSET 0 0.25 0\n    }\n", ""),
    "end_site_without_offset": ("      OFFSET 0 0.25 0\n", ""),
    "end_site_with_channels": ("OFFSET 0 0.25 0", "OFFSET 0 0.25 0\nCHANNELS 1 Xrotation"),
    "end_site_with_no_channels": ("OFFSET 0 0.25 0", "OFFSET 0 0.25 0\nCHANNELS 0"),
    "end_site_with_a_joint": ("OFFSET 0 0.25 0", "JOINT a { OFFSET 0 0 0 }"),
    "two_end_sites": ("    End Site", "    End Site { OFFSET 1 1 1 }\n    End Site"),
    "name_missing": ("JOINT Chest", "JOINT"),
    "name_with_spaces": ("JOINT Chest", "JOINT Upper  Chest"),
    "name_with_colon": ("JOINT Chest", "JOINT mixamorig:Chest"),
    "name_in_umlauts": ("JOINT Chest", "JOINT Br\u00fcst"),
    "name_of_keyword": ("JOINT Chest", "JOINT OFFSET"),
    "name_of_255": ("JOINT Chest", "JOINT " + "x" * 255),
    "name_of_256": ("JOINT Chest", "JOINT " + "x" * 256),
    "names_the_same": ("JOINT Chest", "JOINT Leg"),
    "names_numbered": ("JOINT Chest", "JOINT Leg", "JOINT Shin", "JOINT Leg_2"),
    "name_is_a_brace": ("JOINT Chest", "JOINT }"),
    "six_with_three": (CHEST, "CHANNELS 6 Yrotation Xrotation Zrotation"),
    "three_with_six": ("CHANNELS 6", "CHANNELS 3"),
    "channels_minus_one": (CHEST, "CHANNELS -1"),
    "channels_1e9": (CHEST, "CHANNELS 1e9"),
    "channels_two_and_a_half": (CHEST, "CHANNELS 2.5 Yrotation Xrotation Zrotation"),
    "channels_seven": (CHEST, "CHANNELS 7 Yrotation Xrotation Zrotation"),
    "channel_twice": (CHEST, "CHANNELS 3 Yrotation Yrotation Zrotation"),
    "channel_unknown": (CHEST, "CHANNELS 3 Yrotation Wrotation Zrotation"),
    "channel_of_scale": (CHEST, "CHANNELS 4 Yrotation Xrotation Zrotation Xscale"),
    "channels_zero": (SHIN, "CHANNELS 0", " -7\n", "\n", " 0\n", "\n", " 7\n", "\n"),
    "channels_missing": ("      " + SHIN + "\n", "", " -7\n", "\n", " 0\n", "\n", " 7\n", "\n"),
    "channels_twice": (SHIN, SHIN + "\n" + SHIN),
    "channels_of_positions": (CHEST, "CHANNELS 3 Xposition Zposition Yposition"),
    "channels_after_the_child": (
        "    CHANNELS 3 Xrotation Yrotation Zrotation\n    JOINT Shin", "    JOINT Shin",
        "      }\n    }\n  }\n}", "      }\n    }\n CHANNELS 3 Xrotation Yrotation Zrotation }\n}",
    ),
    "offset_after_channels": ("OFFSET 0 0.9 0\n", "", "JOINT Chest", "OFFSET 0 0.9 0 JOINT Chest"),
    "offset_missing": ("    OFFSET 0.1 -0.05 0\n", ""),
    "offset_twice": ("    OFFSET 0.1 -0.05 0\n", "    OFFSET 0.1 -0.05 0\n    OFFSET 1 2 3\n"),
    "offset_of_two": ("OFFSET 0.1 -0.05 0", "OFFSET 0.1 -0.05"),
    "offset_of_four": ("OFFSET 0.1 -0.05 0", "OFFSET 0.1 -0.05 0 0"),
    "bones_without_length": ("0 0.3 0.1", "0 0 0", "0.1 -0.05 0", "0 0 0", "0 -0.42 0", "0 0 0"),
    "far_away": ("OFFSET 0 0.9 0", "OFFSET 0 9e6 0"),
    "two_roots": ("MOTION", "ROOT Other { OFFSET 0 0 0 CHANNELS 0 }\nMOTION"),
    "root_in_root": ("  JOINT Chest", "  ROOT Chest"),
    "joint_as_root": ("ROOT Hips", "JOINT Hips"),
    "second_motion": ("Frames: 3", "MOTION\nFrames: 3"),
    "hierarchy_missing": ("HIERARCHY\n", ""),
    "frames_more": ("Frames: 3", "Frames: 1000"),
    "frames_fewer": ("Frames: 3", "Frames: 1"),
    "frames_zero": ("Frames: 3", "Frames: 0"),
    "frames_negative": ("Frames: 3", "Frames: -5"),
    "frames_with_point": ("Frames: 3", "Frames: 3.0"),
    "frames_half": ("Frames: 3", "Frames: 2.5"),
    "frames_too_many": ("Frames: 3", "Frames: 99999999999"),
    "frames_spaced": ("Frames: 3", "Frames \t: 3"),
    "frames_no_colon": ("Frames: 3", "Frames 3"),
    "frames_missing": ("Frames: 3\n", ""),
    "time_zero": ("0.0083333", "0"),
    "time_negative": ("0.0083333", "-0.01"),
    "time_tiny": ("0.0083333", "1e-9"),
    "time_long": ("0.0083333", "1000"),
    "time_of_one_second": ("0.0083333", "1"),
    "time_missing": ("Frame Time: 0.0083333\n", ""),
    "time_spaced": ("Frame Time: 0.0083333", "Frame  Time : .0083333"),
    "row_short": (ROW, "0 90 0 0 0 0 1 2 3 4 5 6\n"),
    "row_long": (ROW, "0 90 0 0 0 0 1 2 3 4 5 6 7 8\n"),
    "row_wrapped": (ROW, "0 90 0\n0 0 0\n\n1 2 3 4\n5 6 7\n"),
    "row_wrapped_into_the_next": (ROW + "1 ", "0 90 0\n0 0 0 1 2 3 4 5 6 7 1 "),
    "rows_apart": (ROW, "\n\n" + ROW + "\n \n"),
    "rows_in_one_line": (ROW, ROW.rstrip() + " "),
    "last_row_short": ("180 -180 720 0\n", "180 -180"),
    "row_with_brace": (ROW, "0 90 0 0 0 0 1 2 3 } 5 6 7\n"),
    "text_after_rows": ("720 0\n", "720 0\nthe end\n"),
    "z_up_person": ("OFFSET 0 0.9 0", "OFFSET 0 0 90", "0 90 0 0", "0 0 90 0"),
    "in_millimetres": ("0 90 0 0", "0 900 0 0", "0 -0.42 0", "0 -420 0", "0 -0.4 0", "0 -400 0"),
}  # fmt: skip


def nested(depth: int, siblings: int = 1) -> str:
    joint = "JOINT j { OFFSET 0 1 0 CHANNELS 0\n"
    tree = joint * depth + "}" * depth if siblings == 1 else (joint + "}") * siblings
    return (
        "HIERARCHY ROOT r { OFFSET 0 0 0 CHANNELS 1 Xrotation\n" + tree
        + "}\nMOTION Frames: 1 Frame Time: 0.1\n5\n"
    )  # fmt: skip


def orders() -> dict[str, bytes]:
    files = {}
    for order in itertools.permutations("XYZ"):
        name = "".join(order).lower()
        channels = " ".join(f"{axis}rotation" for axis in order)
        files |= changed(WALK, {f"order_{name}": (CHEST, f"CHANNELS 3 {channels}")})
        mixed = " ".join(f"{axis}rotation {axis}position" for axis in order)
        files |= changed(
            WALK,
            {
                f"six_channels_{name}": (
                    CHEST, f"CHANNELS 6 {mixed}",
                    "1 2 3 4", "1 10 2 20 3 30 4", "-170 20", "-170 11 20 21",
                    " 89.9 40", " 89.9 31 40", "1e-5 -2 90", "1e-5 12 -2 22 90 32",
                )
            },
        )  # fmt: skip
    return files


def bvh_files() -> dict[str, bytes]:
    files = line_ends(WALK) | changed(WALK, RULES) | orders() | dict(cut(WALK, 25))
    files |= with_number(WALK, ROW, "4", "value")
    files |= with_number(WALK, "OFFSET 0 0.3 0.1", "0.3", "offset")
    files |= {
        "only_hierarchy": b"HIERARCHY",
        "no_motion": HEAD.encode(),
        "no_frames_line": (HEAD + "MOTION\n").encode(),
        "no_rows": WALK[: WALK.index(ROW)].encode(),
        "motion_alone": b"HIERARCHY\nMOTION\nFrames: 1\nFrame Time: 0.1\n1\n",
        "another_format": b"# AST/ASF file\n:version 1.10\n",
        "latin1_name": WALK.replace("Chest", "Br\u00fcst").encode("latin-1"),
        "deep": nested(99).encode(),
        "too_deep": nested(101).encode(),
        "wide": nested(1, 60).encode(),
        "no_channel_at_all": b"HIERARCHY ROOT r { OFFSET 0 0 0 CHANNELS 0 }\nMOTION\nFrames: 2\n"
        b"Frame Time: 0.1\n\n\n",
    }
    return files
