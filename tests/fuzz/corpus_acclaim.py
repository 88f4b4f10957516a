# SPDX-License-Identifier: GPL-3.0-or-later
"""The corpus of Acclaim's files: a skeleton and a motion with the line #AMC between them."""

from __future__ import annotations

import itertools

from corpus_text import changed, cut, line_ends, with_number

ASF = """# a small skeleton
:version 1.10
:name small
:units
  mass 1.0
  length 0.45
  angle deg
:documentation
  here we begin
:root
  order TX TY TZ RX RY RZ
  axis XYZ
  position 0 0 0
  orientation 0 0 0
:bonedata
  begin
    id 1
    name thigh
    direction 0.34202 -0.939693 0
    length 7.3
    axis 0 0 20 XYZ
    dof rx ry rz
    limits (-160.0 20.0)
           (-70.0 70.0)
           (-60.0 70.0)
  end
  begin
    id 2
    name shin
    direction 0.34202 -0.939693 0
    length 6.9
    axis 0 0 20 XYZ
    dof rx
    limits (-10.0 170.0)
  end
  begin
    id 3
    name fin
    direction 1 0 0
    length 0.5
    axis 0 0 0 XYZ
  end
:hierarchy
  begin
    root thigh
    thigh shin fin
  end
"""
AMC = """#!OML:ASF small
:FULLY-SPECIFIED
:DEGREES
1
root 5.2 17.3 -4.2 248.435 87.4513 -96.5087
thigh 12.4 0.05 -2.65
shin 36.9
2
root 5.3 17.2 -4.1 247 87.5 -97
thigh -13 0.5 3.97569e-015
shin 37
3
root 5.4 17.1 -4 -179 90 180
thigh 90 90 90
shin -5
"""
BOTH = ASF + "#AMC\n" + AMC
LIMITS = "(-160.0 20.0)\n           (-70.0 70.0)\n           (-60.0 70.0)"
FAMILY = "    thigh shin fin\n"
DOF = "    dof rx ry rz\n"

RULES = {
    "radians": ("angle deg", "angle rad", ":DEGREES", ":RADIANS"),
    "radians_by_the_skeleton": ("angle deg", "angle radians", ":DEGREES\n", ""),
    "angle_unknown": ("angle deg", "angle grad"),
    "angle_missing": ("  angle deg\n", ""),
    "length_zero": ("length 0.45", "length 0"),
    "length_negative": ("length 0.45", "length -1"),
    "length_tiny": ("length 0.45", "length 0.000002"),
    "length_in_centimetres": ("length 0.45", "length 2.54"),
    "units_missing": (":units\n  mass 1.0\n  length 0.45\n  angle deg\n", ""),
    "units_unknown": ("mass 1.0", "colour red"),
    "units_twice": (":root", ":units\n  length 1\n:root"),
    "order_missing": ("  order TX TY TZ RX RY RZ\n", ""),
    "order_short": ("order TX TY TZ RX RY RZ", "order TX RX"),
    "order_with_length": ("order TX TY TZ RX RY RZ", "order TX TY TZ RX RY RZ L"),
    "order_twice_the_same": ("order TX TY TZ RX RY RZ", "order TX TX TZ RX RY RZ"),
    "position": ("position 0 0 0", "position 10 20 30"),
    "position_far": ("position 0 0 0", "position 1e300 0 0"),
    "orientation": ("orientation 0 0 0", "orientation 20 -90 40"),
    "orientation_by_zyx": ("axis XYZ\n  position", "axis ZYX\n  position", "orientation 0 0 0",
                           "orientation 20 -90 40"),
    "axis_unknown": ("axis 0 0 20 XYZ", "axis 0 0 20 XXY"),
    "axis_without_order": ("axis 0 0 20 XYZ", "axis 0 0 20"),
    "axis_missing": ("    axis 0 0 20 XYZ\n", ""),
    "dof_missing": (DOF, "", "thigh 12.4 0.05 -2.65\n", "", "thigh -13 0.5 3.97569e-015\n", "",
                    "thigh 90 90 90\n", ""),
    "dof_empty": ("dof rx\n", "dof\n"),
    "dof_unknown": ("dof rx\n", "dof rq\n"),
    "dof_twice_the_same": ("dof rx ry rz", "dof rx rx rz"),
    "dof_of_translations": ("dof rx\n", "dof tx ty tz rx l\n", "shin 36.9", "shin 1 2 3 36.9 0",
                            "shin 37", "shin 0 0 0 37 0.5", "shin -5", "shin -1 0 1e-3 -5 0"),
    "dof_upper_case": ("dof rx ry rz", "DOF RX RY RZ"),
    "limits_before_dof": (DOF, "", LIMITS + "\n", LIMITS + "\n" + DOF),
    "limits_infinite": (LIMITS, "(-inf inf) (-INF +inf) (-1.#INF 1.#INF)"),
    "limits_few": (LIMITS, "(-160.0 20.0)"),
    "limits_many": (LIMITS, LIMITS + " (1 2) (3 4)"),
    "limits_zero": (LIMITS, "(0 0) (0 0) (0 0)"),
    "limits_odd": (LIMITS, "(-160.0 20.0) (-70"),
    "limits_word": (LIMITS, "(a b)"),
    "direction_zero": ("direction 1 0 0", "direction 0 0 0"),
    "direction_long": ("direction 1 0 0", "direction 3 4 0"),
    "direction_huge": ("direction 1 0 0", "direction 1e200 1e200 0"),
    "direction_of_two": ("direction 1 0 0", "direction 1 0"),
    "direction_missing": ("    direction 1 0 0\n", ""),
    "bone_negative": ("length 0.5", "length -0.5"),
    "bone_too_long": ("length 0.5", "length 1e30"),
    "bone_without_length": ("length 0.5", "length 0", "direction 1 0 0", "direction 0 0 0"),
    "bone_unknown_key": ("    id 1\n", "    colour red\n"),
    "bone_with_masses": ("    id 1\n", "    id 1\n    bodymass 3\n    cofmass 1 2 3\n"),
    "bone_without_name": ("    name thigh\n", ""),
    "bone_without_end": ("  end\n:hierarchy", ":hierarchy"),
    "bone_never_begun": ("  begin\n    id 2\n", "    id 2\n"),
    "bone_called_root": ("name fin", "name Root"),
    "bone_called_end": ("name fin", "name end", "thigh shin fin", "thigh shin end"),
    "bone_called_a_number": ("name fin", "name 7", "thigh shin fin", "thigh shin 7"),
    "bone_with_colon": ("name fin", "name rig:fin", "thigh shin fin", "thigh shin rig:fin"),
    "bone_twice": ("name fin", "name SHIN"),
    "bone_name_of_256": ("name fin", "name " + "x" * 256),
    "names_in_other_case": ("root thigh", "ROOT Thigh", "thigh 12.4", "THIGH 12.4"),
    "blanks_of_all_kinds": ("direction 1 0 0", "direction (1, 0,0) # to the side"),
    "hierarchy_missing": (":hierarchy\n  begin\n    root thigh\n    thigh shin fin\n  end\n", ""),
    "hierarchy_without_end": (FAMILY + "  end\n", FAMILY),
    "hierarchy_unknown_name": ("thigh shin fin", "thigh shin toe fin"),
    "hierarchy_two_parents": (FAMILY, FAMILY + "    shin fin\n"),
    "hierarchy_cycle": (FAMILY, "    shin fin\n    fin shin\n"),
    "hierarchy_own_child": (FAMILY, "    thigh shin\n    fin fin\n"),
    "hierarchy_root_as_child": (FAMILY, "    thigh shin fin root\n"),
    "hierarchy_unreachable": (FAMILY, "    thigh shin\n"),
    "hierarchy_in_pieces": (FAMILY, "    thigh shin\n    thigh fin\n"),
    "hierarchy_empty": ("    root thigh\n    thigh shin fin\n", ""),
    "section_unknown": (":root", ":skin\n  patch 1 2 3\n:root"),
    "section_twice": (":bonedata", ":root\n:bonedata"),
    "documentation_of_keywords": ("here we begin", "begin\n  end\n  root :root\n  name x"),
    "word_before_sections": (":version", "hello\n:version"),
    "amc_header_missing": (":FULLY-SPECIFIED\n:DEGREES\n", ""),
    "amc_rate": (":DEGREES", ":DEGREES\n:SAMPLES-PER-SECOND 30"),
    "amc_rate_zero": (":DEGREES", ":SAMPLES-PER-SECOND 0"),
    "amc_rate_fastest": (":DEGREES", ":SAMPLES-PER-SECOND 10000"),
    "amc_keyword_unknown": (":DEGREES", ":DEGREES\n:COLOUR red"),
    "amc_second_header": ("\n2\n", "\n:DEGREES\n2\n"),
    "amc_from_zero": ("\n1\n", "\n0\n", "\n2\n", "\n1\n", "\n3\n", "\n2\n"),
    "amc_gap": ("\n2\n", "\n20\n", "\n3\n", "\n2000000000000\n"),
    "amc_frame_twice": ("\n2\n", "\n1\n"),
    "amc_backwards": ("\n3\n", "\n1\n"),
    "amc_frame_half": ("\n2\n", "\n1.5\n"),
    "amc_frame_negative": ("\n1\n", "\n-1\n"),
    "amc_frame_beyond": ("\n2\n", "\n1e300\n"),
    "amc_no_number": ("\n1\n", "\n"),
    "amc_two_numbers": ("\n2\n", "\n2 3\n"),
    "amc_bone_unknown": ("shin 37\n", "shin 37\ntoe 1\n"),
    "amc_bone_missing": ("shin 37\n", ""),
    "amc_bone_twice": ("shin 37\n", "shin 37\nshin 37\n"),
    "amc_root_missing": ("root 5.3 17.2 -4.1 247 87.5 -97\n", ""),
    "amc_other_order": ("thigh -13 0.5 3.97569e-015\nshin 37\n", "shin 37\nfin\nthigh -13 0.5 0\n"),
    "amc_value_missing": ("thigh 90 90 90", "thigh 90 90"),
    "amc_value_too_many": ("thigh 90 90 90", "thigh 90 90 90 90"),
    "amc_values_on_two_lines": ("thigh 90 90 90", "thigh 90\n90 90"),
    "amc_far_away": ("root 5.3", "root 1e9"),
    "amc_cut_in_a_frame": ("thigh 90 90 90\nshin -5\n", "thigh 90 90 90\n"),
    "amc_cut_in_a_number": ("90 90\nshin -5\n", "90 9e"),
}  # fmt: skip


def orders() -> dict[str, bytes]:
    changes = {}
    for order in itertools.permutations("xyz"):
        name = "".join(order)
        dof = " ".join(f"r{axis}" for axis in order)
        changes[f"axis_{name}"] = ("axis 0 0 20 XYZ", f"axis 10 -90 20 {name.upper()}")
        changes[f"dof_{name}"] = (DOF, f"    dof {dof}\n")
        changes[f"order_{name}"] = (
            "order TX TY TZ RX RY RZ",
            f"order {dof} " + " ".join(f"t{axis}" for axis in order),
        )
    return changed(BOTH, changes)


def sections_in_another_order() -> bytes:
    at = [ASF.index(word) for word in (":units", ":root", ":bonedata", ":hierarchy")]
    parts = [ASF[begin:end] for begin, end in itertools.pairwise([0, *at, len(ASF)])]
    return ("".join(reversed(parts)) + "#AMC\n" + AMC).encode()


def acclaim_files() -> dict[str, bytes]:
    files = line_ends(BOTH) | changed(BOTH, RULES) | orders() | dict(cut(BOTH, 30))
    files |= with_number(BOTH, "thigh 12.4 0.05 -2.65", "0.05", "value")
    files |= with_number(BOTH, "direction 1 0 0", "1", "direction")
    files |= {
        "sections_in_another_order": sections_in_another_order(),
        "skeleton_alone": ASF.encode(),
        "motion_alone": AMC.encode(),
        "motion_empty": (ASF + "#AMC\n").encode(),
        "latin1": BOTH.replace("fin", "H\u00fcfte").encode("latin-1"),
        "latin1_bone_that_moves": BOTH.replace("shin", "sch\u00edn").encode("latin-1"),
        "root_alone": b":root\norder rx\n:bonedata\n:hierarchy\nbegin\nend\n#AMC\n1\nroot 5\n",
    }
    return files
