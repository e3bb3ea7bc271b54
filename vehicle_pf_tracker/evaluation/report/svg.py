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
from typing import Any

from matplotlib import rc_context
from matplotlib.figure import Figure

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

STYLE: Any = {
    "svg.fonttype": "none",
    "svg.hashsalt": "vehicle_pf_tracker",
    "font.size": 8.0,
    "axes.edgecolor": _INK["rule"],
    "axes.labelcolor": _INK["muted"],
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "text.color": _INK["ink"],
    "xtick.color": _INK["rule"],
    "ytick.color": _INK["rule"],
    "xtick.labelcolor": _INK["muted"],
    "ytick.labelcolor": _INK["muted"],
    "grid.color": _INK["rule"],
    "grid.linewidth": 0.5,
}
"""Settings to make figures under; see `matplotlib.rc_context`."""


def ink(name: str) -> str:
    """Return the stand-in for a colour of the page, such as ``ink`` or ``s0``."""
    return _INK[name]


class SvgMaker:
    """Turns figures into SVG elements that can stand in one page: no two share an id."""

    def __init__(self) -> None:
        self._numbers = itertools.count(1)

    def make(self, figure: Figure, label: str) -> str:
        """Return `figure` as an SVG element that is read out as `label`."""
        text = io.StringIO()
        nothing = dict.fromkeys(("Date", "Creator", "Format", "Type"))
        with rc_context(STYLE):
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
