"""The tracker variants by name: node executable minus ``_tracker``, and config file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.trackers.base import BaseTracker
from vehicle_pf_tracker.trackers.fusion.parameters import FusionParameters
from vehicle_pf_tracker.trackers.fusion.tracker import FusionTracker
from vehicle_pf_tracker.trackers.papers.adaptive import AdaptiveParameters, AdaptiveTracker
from vehicle_pf_tracker.trackers.papers.apf import ApfTracker
from vehicle_pf_tracker.trackers.papers.apf_parameters import ApfParameters
from vehicle_pf_tracker.trackers.papers.conventional import (
    ConventionalParameters,
    ConventionalTracker,
)
from vehicle_pf_tracker.trackers.papers.hpfms import HpfmsParameters, HpfmsTracker
from vehicle_pf_tracker.trackers.papers.mfpf import MfpfTracker
from vehicle_pf_tracker.trackers.papers.mfpf_parameters import (
    MfpfParameters,
    SfpfColorParameters,
    SfpfEdgeParameters,
    SfpfTextureParameters,
)
from vehicle_pf_tracker.trackers.papers.ms import MsParameters, MsTracker
from vehicle_pf_tracker.trackers.papers.pf import PfParameters, PfTracker
from vehicle_pf_tracker.trackers.papers.pfcl import PfclParameters, PfclTracker
from vehicle_pf_tracker.trackers.papers.sapf import SapfParameters, SapfTracker
from vehicle_pf_tracker.trackers.papers.sfpf import (
    SfpfColorTracker,
    SfpfEdgeTracker,
    SfpfTextureTracker,
)


@dataclass(frozen=True, slots=True)
class Variant:
    """A tracker class with its parameter dataclass, and what it is in one line."""

    name: str
    tracker: type[BaseTracker[Any]]
    parameters: type[Any]
    summary: str


VARIANTS: Mapping[str, Variant] = MappingProxyType(
    {
        variant.name: variant
        for variant in (
            Variant(
                "apf",
                ApfTracker,
                ApfParameters,
                "adaptive particle filter, two regimes (Scharcanski et al. 2011)",
            ),
            Variant(
                "pf",
                PfTracker,
                PfParameters,
                "colour particle filter (Perez et al. 2002)",
            ),
            Variant(
                "sapf",
                SapfTracker,
                SapfParameters,
                "annealed particle filter (Deutscher et al. 2000)",
            ),
            Variant(
                "hpfms",
                HpfmsTracker,
                HpfmsParameters,
                "few particles refined by mean shift (Maggio and Cavallaro 2005)",
            ),
            Variant(
                "pfcl",
                PfclTracker,
                PfclParameters,
                "colour and straight lines (Xiong and Debrunner 2004)",
            ),
            Variant(
                "ms",
                MsTracker,
                MsParameters,
                "mean shift, without particles (Comaniciu et al. 2003)",
            ),
            Variant(
                "mfpf",
                MfpfTracker,
                MfpfParameters,
                "colour, edges and texture with adaptive weights (Abdulla et al. 2022)",
            ),
            Variant(
                "sfpf_color",
                SfpfColorTracker,
                SfpfColorParameters,
                "colour alone (Abdulla et al. 2022)",
            ),
            Variant(
                "sfpf_edge",
                SfpfEdgeTracker,
                SfpfEdgeParameters,
                "edge directions alone (Abdulla et al. 2022)",
            ),
            Variant(
                "sfpf_texture",
                SfpfTextureTracker,
                SfpfTextureParameters,
                "texture alone (Abdulla et al. 2022)",
            ),
            Variant(
                "conventional",
                ConventionalTracker,
                ConventionalParameters,
                "colour, all particles resampled until enough count (Khong et al.)",
            ),
            Variant(
                "adaptive",
                AdaptiveTracker,
                AdaptiveParameters,
                "colour, only low weights resampled until enough count (Khong et al.)",
            ),
            Variant(
                "fusion",
                FusionTracker,
                FusionParameters,
                "fused cues, scale, camera motion, return from total occlusions (this package)",
            ),
        )
    }
)


def find_variant(name: str) -> Variant:
    """Look up a variant.

    Raises
    ------
    InputError
        If there is none of this name.
    """
    if name not in VARIANTS:
        raise InputError(f"there is no variant {name!r}; choose one of {', '.join(VARIANTS)}")
    return VARIANTS[name]
