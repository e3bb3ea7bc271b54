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

"""Parameters that variants of several papers have, each with one text."""

from __future__ import annotations

from typing import Any

from vehicle_pf_tracker.filtering.resampling import SCHEMES
from vehicle_pf_tracker.parameters.table import parameter


def as_printed_switch(source: str) -> Any:
    """Make the switch that follows the paper to the letter; `source` names what it undoes."""
    return parameter(
        False,
        "Follow the paper to the letter: overrides every interpretation below.",
        source=source,
    )


def histogram_bits_parameter(*, tuned: bool = False) -> Any:
    """Make the resolution of joint colour histograms."""
    return parameter(
        3,
        "More: finer colours, more easily upset by light and noise.",
        minimum=1,
        maximum=5,
        unit="bits/channel",
        source="P1 section III-C",
        effect="relearns",
        tuned=tuned,
    )


def resampling_parameter(source: str) -> Any:
    """Make the choice of a resampling scheme; `source` is where the paper resamples."""
    return parameter(
        "multinomial",
        "How ancestors are drawn; systematic and stratified vary less.",
        choices=SCHEMES,
        source=source,
    )
