# SPDX-License-Identifier: GPL-3.0-or-later
"""The evaluation of Tautges et al. 2011, section 6, with the method of the paper and our own."""

from .document import write_document
from .parts import PARTS, run_part
from .runs import Runs
from .section import Bars, Lines, Matrix, Section, Table

__all__ = [
    "PARTS",
    "Bars",
    "Lines",
    "Matrix",
    "Runs",
    "Section",
    "Table",
    "run_part",
    "write_document",
]
