# SPDX-License-Identifier: GPL-3.0-or-later
"""German."""

from __future__ import annotations

from .german_core import CORE
from .german_labels import LABELS
from .german_models import MODELS
from .german_reports import REPORTS
from .german_sentences import SENTENCES
from .german_teaching import TEACHING
from .german_tooltips import TOOLTIPS

TEXTS: dict[str, str] = {**LABELS, **SENTENCES, **TOOLTIPS, **MODELS, **REPORTS, **TEACHING, **CORE}
"""What to show for each English text; words in {braces} are filled in."""
