"""`sfpf_color`, `sfpf_edge`, `sfpf_texture`: the single-feature filters of P2 (section III).

Each is the algorithm of `mfpf` with one feature: it predicts while that feature is below its
threshold.
"""

from __future__ import annotations

from collections.abc import Mapping

from vehicle_pf_tracker.image.colour import RgbMarginals
from vehicle_pf_tracker.image.window_feature import WindowFeature
from vehicle_pf_tracker.trackers.papers.mfpf import FeatureFilter, edge_feature
from vehicle_pf_tracker.trackers.papers.mfpf_parameters import (
    TEXTURES,
    SfpfColorParameters,
    SfpfEdgeParameters,
    SfpfTextureParameters,
)


class SfpfColorTracker(FeatureFilter[SfpfColorParameters]):
    """Histograms of red, green and blue."""

    @property
    def _settings(self) -> SfpfColorParameters:
        return self.parameters.effective()

    def _make_features(self) -> Mapping[str, WindowFeature]:
        return {"color": RgbMarginals()}


class SfpfEdgeTracker(FeatureFilter[SfpfEdgeParameters]):
    """Directions of the gradient at edge points."""

    @property
    def _settings(self) -> SfpfEdgeParameters:
        return self.parameters.effective()

    def _make_features(self) -> Mapping[str, WindowFeature]:
        return {"edge": edge_feature(self._settings.edges)}


class SfpfTextureTracker(FeatureFilter[SfpfTextureParameters]):
    """Grey-level co-occurrences, or another texture that P2 tried."""

    @property
    def _settings(self) -> SfpfTextureParameters:
        return self.parameters.effective()

    def _make_features(self) -> Mapping[str, WindowFeature]:
        return {"texture": TEXTURES[self._settings.texture]()}
