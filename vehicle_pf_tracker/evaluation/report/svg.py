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

"""Figures as SVG that stands in a page and takes its colours from the page's scheme."""

from __future__ import annotations

import html
import io
import itertools
import re
from collections.abc import Mapping
from types import MappingProxyType

from matplotlib import rc_context
from matplotlib.figure import Figure

from vehicle_pf_tracker.evaluation.report.look import Look

_INK: Mapping[str, str] = MappingProxyType(
    {
        "ink": "#010101",
        "muted": "#020202",
        "rule": "#030303",
        "total": "#040404",
        "partial": "#050505",
        "accent": "#060606",
        **{f"s{slot}": f"#0a0a{slot:02x}" for slot in range(6)},
    }
)
"""Stand-ins for the page's colours: what is drawn in one of them is drawn in ``var(--name)``."""


PAGE = Look(_INK, 8.0, "none")
"""Figures of the page, which are recoloured by its scheme."""


class SvgMaker:
    """Turns figures into SVG elements that can stand in one page: no two share an id."""

    def __init__(self) -> None:
        self._numbers = itertools.count(1)

    def make(self, figure: Figure, label: str) -> str:
        """Return `figure` as an SVG element that is read out as `label`."""
        text = io.StringIO()
        nothing = dict.fromkeys(("Date", "Creator", "Format", "Type"))
        with rc_context(PAGE.settings):
            figure.savefig(text, format="svg", transparent=True, metadata=nothing)
        element = text.getvalue()
        element = element[element.index("<svg") :]
        element = re.sub(r"<metadata>.*?</metadata>\s*", "", element, flags=re.DOTALL)
        element = re.sub(r"<!--.*?-->\s*", "", element, flags=re.DOTALL)
        prefix = f"f{next(self._numbers)}-"
        for before in (' id="', 'href="#', "url(#"):
            element = element.replace(before, before + prefix)
        for name, colour in _INK.items():
            element = element.replace(colour, f"var(--{name})")
        size = re.search(r'viewBox="[^"]*"', element)
        assert size is not None
        head = f'<svg {size[0]} role="img" aria-label="{html.escape(label)}"'
        head += ' xmlns:xlink="http://www.w3.org/1999/xlink"'
        return re.sub(r"^<svg[^>]*", head, element).replace("\n", " ").replace("  ", " ")
