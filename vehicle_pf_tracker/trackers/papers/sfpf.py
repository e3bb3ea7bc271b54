# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`sfpf_color`, `sfpf_edge`, `sfpf_texture`: the single-feature filters of P2 (section III).

Each is the algorithm of `mfpf` with one feature: it predicts while that feature is below its
threshold. Section IV calls the doubled radius, the threshold and the prediction mode additions to
"the basic SFPF algorithm"; with `extended` off the filter is the basic one (interpretation 32).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TypeVar

from vehicle_pf_tracker.image.windows.colour import RgbMarginals
from vehicle_pf_tracker.image.windows.window import WindowFeature
from vehicle_pf_tracker.parameters.table import group, parameter
from vehicle_pf_tracker.trackers.papers.mfpf import FeatureFilter
from vehicle_pf_tracker.trackers.papers.mfpf_parameters import (
    PRINTED_EDGES,
    TEXTURE_FEATURES,
    EdgeParameters,
    FeatureFilterParameters,
    edge_feature,
    texture_parameter,
)


@dataclass(frozen=True, slots=True)
class SfpfParameters(FeatureFilterParameters):
    """Parameters of every single-feature filter."""

    extended: bool = parameter(
        True, "Search wider at the start, and predict while the feature is below its threshold, as "
        "mfpf does; off leaves out what section IV adds.",
        source="P2 sections III and IV, interpretation 32",
    )  # fmt: skip

    def printed(self: SfpfParametersT) -> SfpfParametersT:
        """Return the parameters as printed; see `CommonParameters.printed`."""
        return replace(FeatureFilterParameters.printed(self), extended=False)


SfpfParametersT = TypeVar("SfpfParametersT", bound=SfpfParameters)


@dataclass(frozen=True, slots=True)
class SfpfColorParameters(SfpfParameters):
    """Parameters of `sfpf_color`."""


@dataclass(frozen=True, slots=True)
class SfpfEdgeParameters(SfpfParameters):
    """Parameters of `sfpf_edge`."""

    edges: EdgeParameters = group(EdgeParameters)

    def printed(self) -> SfpfEdgeParameters:
        """Return the parameters as printed; see `CommonParameters.printed`."""
        return replace(SfpfParameters.printed(self), edges=PRINTED_EDGES)


@dataclass(frozen=True, slots=True)
class SfpfTextureParameters(SfpfParameters):
    """Parameters of `sfpf_texture`."""

    texture: str = texture_parameter()

    def printed(self) -> SfpfTextureParameters:
        """Return the parameters as printed; see `CommonParameters.printed`."""
        return replace(SfpfParameters.printed(self), texture="glcm")


class SfpfColorTracker(FeatureFilter[SfpfColorParameters]):
    """Histograms of red, green and blue."""

    def _make_features(self) -> Mapping[str, WindowFeature]:
        return {"color": RgbMarginals()}


class SfpfEdgeTracker(FeatureFilter[SfpfEdgeParameters]):
    """Directions of the gradient at edge points."""

    def _make_features(self) -> Mapping[str, WindowFeature]:
        return {"edge": edge_feature(self._settings.edges)}


class SfpfTextureTracker(FeatureFilter[SfpfTextureParameters]):
    """Grey-level co-occurrences, or another texture that P2 tried."""

    def _make_features(self) -> Mapping[str, WindowFeature]:
        return {"texture": TEXTURE_FEATURES[self._settings.texture]()}
