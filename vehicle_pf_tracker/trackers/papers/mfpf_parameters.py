# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Parameters of `mfpf` and `sfpf_*` (P2), with a switch for every interpretation."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import TypeVar

from vehicle_pf_tracker.image.windows.gradients import GradientDirections
from vehicle_pf_tracker.image.windows.textures import (
    BinaryPatterns,
    Cooccurrence,
    HaralickStatistics,
)
from vehicle_pf_tracker.image.windows.window import WindowFeature
from vehicle_pf_tracker.parameters.table import group, parameter
from vehicle_pf_tracker.trackers.papers.shared import (
    LikelihoodParameters,
    as_printed_switch,
    resampling_parameter,
    sigma_v_parameter,
    squared_distance_parameter,
)
from vehicle_pf_tracker.trackers.parameters import ParticleParameters, share

TEXTURE_FEATURES: Mapping[str, Callable[[], WindowFeature]] = {
    "glcm": Cooccurrence,
    "lbp": BinaryPatterns,
    "haralick": HaralickStatistics,
}
"""The textures that P2 tried, by the word that the parameter takes."""


texture_parameter = functools.partial(
    parameter, "glcm",
    "The histogram that describes texture; the paper tried all three and kept glcm.",
    choices=TEXTURE_FEATURES, source="P2 section III-D", effect="relearns",
)  # fmt: skip
"""Declare the choice of the texture feature."""


@dataclass(frozen=True, slots=True)
class FeatureLikelihoodParameters(LikelihoodParameters):
    """Decrease of the weights with the distance of the histograms, as P2 has it."""

    sigma_v: float = sigma_v_parameter(0.1, source="P2 eq. 10, interpretation 31 (printed: 1.5)")
    squared_distance: bool = squared_distance_parameter(source="P2 eq. 10 (printed squared)")


@dataclass(frozen=True, slots=True)
class DispersionParameters:
    """Dispersion of the particles."""

    radius: float = parameter(
        14.0, "Larger: follows faster changes of speed, and more similar vehicles.",
        bounds=(0.01, 1000.0), unit="px/frame", source="P2 section IV, interpretation 36",
        tuned=True,
    )  # fmt: skip
    noise: str = parameter(
        "disc",
        "Draw the noise evenly from the disc, which bounds the search, or from a Gaussian of the "
        "same variance, as printed.",
        choices=("disc", "gaussian"), source="P2 eq. 5, interpretation 25",
    )  # fmt: skip
    uncertain_factor: float = parameter(
        2.0, "Larger: searches further around the start and around predictions.",
        bounds=(1.0, 100.0), unit="radii", source="P2 section IV",
    )  # fmt: skip
    start: float = parameter(
        1.0,
        "Longer: the wider search around the start lasts until the speed is known, which a radius "
        "of about the speed needs; 1 is the first step alone, as printed.",
        bounds=(1.0, 1000.0), unit="frames", source="P2 section IV, interpretations 30 and 36",
    )  # fmt: skip
    growth: float = parameter(
        1.0, "Larger: the search around predictions widens faster during an occlusion.",
        bounds=(0.0, 100.0), unit="px/frame",
        source="P2 section IV, interpretation 19 (no value printed)",
    )  # fmt: skip
    largest: float = parameter(
        60.0, "Larger: the search may widen further, at more time per frame.",
        bounds=(0.0, 10_000.0), unit="px", source="interpretation 19",
    )  # fmt: skip


@dataclass(frozen=True, slots=True)
class ConfidenceParameters:
    """Confidence that a feature needs in order to count."""

    best_share: float = share(
        0.1,
        "Higher: the average similarity takes in particles further from the vehicle; 1 takes all, "
        "as printed.",
        unit="share of the particles", source="P2 section IV, interpretation 19",
        effect="relearns",
    )  # fmt: skip
    threshold: float = share(
        0.7, "Higher: features drop out at smaller losses of similarity (printed: 0.8).",
        unit="share of the initial average similarity", source="P2 Table II, interpretation 19",
        tuned=True,
    )  # fmt: skip


@dataclass(frozen=True, slots=True)
class EdgeParameters:
    """Definition of edge points and of their direction."""

    threshold: float = parameter(
        0.3, "Higher: only the strongest edges count (printed: 0.8).", bounds=(0.01, 1.0),
        unit="share of the window's strongest gradient",
        source="P2 section III-C, interpretation 14", effect="relearns", tuned=True,
    )  # fmt: skip
    floor: float = parameter(
        40.0,
        "Higher: noise and faint edges count less; 0 counts them in windows with nothing else, as "
        "printed. A step of one grey level makes a gradient of 4.",
        bounds=(0.0, 1500.0), unit="grey levels", source="P2 section III-C, interpretation 14",
        effect="relearns",
    )  # fmt: skip
    in_frame: bool = parameter(
        True, "Take the gradient in the frame; off takes it in each window by itself, as printed.",
        source="P2 eq. 6, interpretation 14", effect="relearns",
    )  # fmt: skip
    signed: bool = parameter(
        True,
        "Distinguish light-to-dark from dark-to-light; off folds them by the printed arctangent.",
        source="P2 eq. 7, interpretation 13", effect="relearns",
    )  # fmt: skip


def edge_feature(parameters: EdgeParameters) -> GradientDirections:
    """Make the edge feature of these parameters."""
    return GradientDirections(
        parameters.threshold, parameters.in_frame, parameters.signed, parameters.floor
    )


PRINTED_EDGES = EdgeParameters(threshold=0.8, floor=0.0, in_frame=False, signed=False)
"""Edge feature as printed in P2, section III-C."""
FilterParametersT = TypeVar("FilterParametersT", bound="FeatureFilterParameters")


@dataclass(frozen=True, slots=True)
class FeatureFilterParameters(ParticleParameters):
    """Common parameters of `mfpf` and its single-feature filters."""

    as_printed: bool = as_printed_switch(
        source="interpretations 12 to 19, 25, 26, 30 to 32, 34 and 35"
    )
    reference_weight: float = share(
        0.7, "Higher: the reference keeps more of the first frame and follows the last one less.",
        source="P2 eq. 9, interpretation 15 (no value printed)", tuned=True,
    )  # fmt: skip
    delayed_reference: bool = parameter(
        False, "On: the reference takes the histogram of the frame before the last, as printed; "
        "off that of the last.",
        source="P2 eq. 8 and 9, interpretation 34",
    )  # fmt: skip
    velocity_window: int = parameter(
        5, "Longer: a steadier speed that follows turns later; 1 takes the last move, as printed.",
        bounds=(1, 10_000), unit="frames", source="P2 eq. 5, interpretation 12", tuned=True,
    )  # fmt: skip
    estimate: str = parameter(
        "mean", "The weighted mean of the particles, or the best one, as printed.",
        choices=("mean", "best"), source="P2 eq. 12, 13 and 18, interpretation 17",
    )  # fmt: skip
    resampling: str = resampling_parameter(source="P2 eq. 15")
    resample_below: float = share(
        0.5, "Higher: resamples at larger effective sample sizes; 1 always.",
        unit="share of the particles", source="P2 eq. 14, interpretation 16",
    )  # fmt: skip
    weight_recursion: bool = parameter(
        True, "A particle's previous weight is a factor of its next where nothing was resampled "
        "between; off takes the present frame's alone.",
        source="P2 eq. 3, 10 and 11, interpretation 35",
    )  # fmt: skip
    likelihood: FeatureLikelihoodParameters = group(FeatureLikelihoodParameters)
    dispersion: DispersionParameters = group(DispersionParameters)
    confidence: ConfidenceParameters = group(ConfidenceParameters)

    # Parameter of `sfpf_*`: `mfpf` is the extension.
    extended = True
    # Parameters of `mfpf`: one feature has no other to be joined with, or to drop out beside.
    update_unused = False
    joint_resampling = True

    @property
    def search_factor(self) -> float:
        """Radii that are searched at the start and in predictions, which only section IV has."""
        return self.dispersion.uncertain_factor if self.extended else 1.0

    def printed(self: FilterParametersT) -> FilterParametersT:
        """Return the parameters as printed; see `CommonParameters.printed`."""
        return replace(
            self,
            delayed_reference=True,
            velocity_window=1,
            estimate="best",
            resampling="multinomial",
            resample_below=1.0,
            weight_recursion=True,
            likelihood=FeatureLikelihoodParameters(sigma_v=1.5),
            dispersion=replace(self.dispersion, noise="gaussian", uncertain_factor=2.0, start=1.0),
            confidence=ConfidenceParameters(best_share=1.0, threshold=0.8),
        )


@dataclass(frozen=True, slots=True)
class MfpfParameters(FeatureFilterParameters):
    """Parameters of `mfpf`."""

    edges: EdgeParameters = group(EdgeParameters)
    texture: str = texture_parameter()
    update_unused: bool = parameter(
        False,
        "On: also the references of features that have dropped out follow the last estimate, as "
        "printed; off keeps them, so that they do not learn what has covered the vehicle.",
        source="P2 section IV step 2, interpretation 26",
    )
    joint_resampling: bool = parameter(
        True,
        "Resample once, on the product of the features' weights; off keeps the particles that "
        "survive in every feature's own resampling, as printed.",
        source="P2 section IV, interpretation 18",
    )

    def printed(self) -> MfpfParameters:
        """Return the parameters as printed; see `CommonParameters.printed`."""
        return replace(
            FeatureFilterParameters.printed(self),
            edges=PRINTED_EDGES,
            texture="glcm",
            update_unused=True,
            joint_resampling=False,
        )
