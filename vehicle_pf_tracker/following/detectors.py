# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Detector that parameters ask for, made anew whenever a stream begins anew."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from vehicle_pf_tracker.core.progress import ShowShare, silent
from vehicle_pf_tracker.detection.detector import Detector
from vehicle_pf_tracker.detection.motion_detector import MotionDetector
from vehicle_pf_tracker.detection.network_detector import NetworkDetector
from vehicle_pf_tracker.detection.parameters import (
    MODEL_DETECTOR,
    MOTION_DETECTOR,
    DetectorParameters,
)
from vehicle_pf_tracker.following.networks.opened_network import open_network


@dataclass(frozen=True)
class _Same:
    """Maker of a detector that keeps nothing between images: always the same object."""

    detector: Detector

    def __call__(self) -> Detector:
        return self.detector


def detector_maker(
    parameters: DetectorParameters, progress: ShowShare = silent
) -> Callable[[], Detector] | None:
    """Return a function that makes the detector; None where there shall be none.

    Raises
    ------
    InputError
        If the network cannot be used.
    """
    # It learns a background, and so is made anew for each stream; a network keeps nothing.
    if parameters.kind == MOTION_DETECTOR:
        return MotionDetector
    if parameters.kind == MODEL_DETECTOR:
        model = parameters.model
        return _Same(NetworkDetector(open_network(model, progress), model, parameters))
    return None
