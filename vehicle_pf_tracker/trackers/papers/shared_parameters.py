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
