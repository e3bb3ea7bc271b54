# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""The figures of a report, in its page and as files for a paper of two columns."""

from __future__ import annotations

import html
import io
import itertools
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any

from matplotlib import rc_context

from vehicle_pf_tracker.evaluation.report.aggregates import Aggregates
from vehicle_pf_tracker.evaluation.report.figures import PAGE, PAPER, Drawn, draw_all
from vehicle_pf_tracker.evaluation.report.scored_runs import ScoredEvaluation
from vehicle_pf_tracker.offline.output_files import make_folder, replacing

FORMATS = ("pdf", "svg", "png")
FIGURES = "figures"
_DPI = 300
"""Resolution of PNG files, which IEEE asks of colour pictures."""

_METADATA: Mapping[str, dict[str, Any]] = MappingProxyType(
    {
        "pdf": {"CreationDate": None, "Creator": None, "Producer": None},
        "svg": {"Date": None, "Creator": None},
        "png": {"Software": None},
    }
)
"""No date and no version, so that the same folder gives the same files."""


class SvgMaker:
    """Turns figures into SVG elements that can stand in one page: no two share an id."""

    def __init__(self) -> None:
        self._numbers = itertools.count(1)

    def make(self, drawn: Drawn) -> str:
        """Return a figure as an SVG element that is read out."""
        text = io.StringIO()
        nothing = dict.fromkeys(("Date", "Creator", "Format", "Type"))
        with rc_context(PAGE.settings):
            drawn.figure.savefig(text, format="svg", transparent=True, metadata=nothing)
        element = text.getvalue()
        element = element[element.index("<svg") :]
        element = re.sub(r"<metadata>.*?</metadata>\s*", "", element, flags=re.DOTALL)
        element = re.sub(r"<!--.*?-->\s*", "", element, flags=re.DOTALL)
        prefix = f"f{next(self._numbers)}-"
        for before in (' id="', 'href="#', "url(#"):
            element = element.replace(before, before + prefix)
        for name, colour in PAGE.colours.items():
            element = element.replace(colour, f"var(--{name})")
        size = re.search(r'viewBox="[^"]*"', element)
        assert size is not None
        head = f'<svg {size[0]} role="img" aria-label="{html.escape(drawn.spoken)}"'
        head += ' xmlns:xlink="http://www.w3.org/1999/xlink"'
        return re.sub(r"^<svg[^>]*", head, element).replace("\n", " ").replace("  ", " ")


def write_figures(
    evaluation: ScoredEvaluation,
    aggregates: Aggregates,
    slots: Mapping[str, int],
    formats: Sequence[str],
) -> list[Path]:
    """Write every figure of the page to ``figures/``, in each of the formats.

    Raises
    ------
    InputError
        If they cannot be written.
    """
    folder = make_folder(evaluation.folder.path / FIGURES)
    written = []
    for name, drawn in draw_all(evaluation, aggregates, slots, PAPER).items():
        figure = drawn.figure
        with rc_context(PAPER.settings):
            # Laid out once: each drawing moves a constrained layout a little further.
            figure.draw_without_rendering()
            figure.set_layout_engine("none")
        for kind in formats:
            path = folder / f"{name}.{kind}"
            with replacing(path) as partial, rc_context(PAPER.settings):
                figure.savefig(partial, format=kind, dpi=_DPI, metadata=_METADATA[kind])
            written.append(path)
    return written
