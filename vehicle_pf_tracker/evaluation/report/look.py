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

"""Colours and letters of figures, for a page and for a paper."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, slots=True)
class Look:
    """Colours and letters that figures are drawn with.

    Attributes
    ----------
    colours : mapping of str to str
        Colours by name, such as ``ink``, ``accent`` and ``s0`` for the first style of a line.
    letters : float
        Size of the letters, points.
    svg_letters : str
        ``none`` leaves the letters of an SVG to the reader's fonts, ``path`` draws them.
    """

    colours: Mapping[str, str]
    letters: float
    svg_letters: str

    def __getitem__(self, name: str) -> str:
        """Return the colour `name`."""
        return self.colours[name]

    @property
    def settings(self) -> Any:
        """Settings to make figures under; see `matplotlib.rc_context`."""
        return {
            "svg.fonttype": self.svg_letters,
            "svg.hashsalt": "vehicle_pf_tracker",
            "pdf.fonttype": 42,  # journals refuse matplotlib's usual Type 3
            "font.size": self.letters,
            "axes.edgecolor": self["rule"],
            "axes.labelcolor": self["muted"],
            "axes.linewidth": 0.8,
            "axes.spines.top": False,
            "axes.spines.right": False,
            "text.color": self["ink"],
            "xtick.color": self["rule"],
            "ytick.color": self["rule"],
            "xtick.labelcolor": self["muted"],
            "ytick.labelcolor": self["muted"],
            "grid.color": self["rule"],
            "grid.linewidth": 0.5,
        }
