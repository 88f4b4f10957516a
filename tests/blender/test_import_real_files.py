# SPDX-License-Identifier: GPL-3.0-or-later
"""File > Import on files of many exporters, where they are at hand."""

import bpy
from support import real_data
from test_import import _check_acclaim, _check_bvh

RATES = ((24, 1.0), (25, 1.0), (30, 1.001), (60, 1.0))


def _files(pattern):
    files = sorted(real_data().glob(pattern))
    assert files, pattern
    return files


def test_every_exporters_bvh_is_where_it_should_be():
    render = bpy.context.scene.render
    for index, path in enumerate(_files("bvh_exporters/*/*.bvh")):
        render.fps, render.fps_base = RATES[index % len(RATES)]
        unit, unit_m = ("DM", 0.1) if "makehuman" in path.parent.name else ("CM", 0.01)
        _check_bvh(path, unit_m, frames=None, unit=unit)
        bpy.ops.wm.read_homefile(use_empty=True)
        render = bpy.context.scene.render


def test_cmu_bvh():
    bpy.context.scene.render.fps = 60
    for path in _files("cmu/bvh/*.bvh")[:3]:
        _check_bvh(path, 0.0254 / 0.45, frames=None, unit="CMU")


def test_acclaim_files():
    for pattern in (
        "hdm05/*_squat1Reps_001_120.amc",
        "cmu/asf_amc/*.amc",
        "acclaim_variants/*.amc",
    ):
        for path in _files(pattern)[:3]:
            _check_acclaim(path, 120.0)
