# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Parameters of `traffic`; docs/traffic.md has the model."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_pf_tracker.detection.parameters import DetectorParameters
from vehicle_pf_tracker.parameters.table import group, parameter
from vehicle_pf_tracker.trackers.parameters import frame_rate_parameter


@dataclass(frozen=True, slots=True)
class RoadMotionParameters:
    """Motion of vehicles on the plane of the road."""

    horizon: float = parameter(
        -0.2,
        "Row of the horizon, 0 the upper border and 1 the lower one; negative: above the image. "
        "Far below zero: vehicles keep their size and speed in px.",
        bounds=(-100.0, 0.9), unit="of the image's height", tuned=(-0.5, 0.3),
    )  # fmt: skip
    acceleration: float = parameter(
        2.0,
        "Larger: follows brakes and turns faster; a hidden vehicle is found over a wider place.",
        bounds=(0.01, 50.0), unit="m/s^2", tuned=(0.7, 5.0),
    )  # fmt: skip
    top_speed: float = parameter(
        25.0, "Larger: a new vehicle is looked for further away in its second frame.",
        bounds=(0.1, 100.0), unit="m/s",
    )  # fmt: skip


@dataclass(frozen=True, slots=True)
class DetectionParameters:
    """Use of detections."""

    edge_noise: float = parameter(
        0.05, "Larger: boxes are smoothed more.", bounds=(0.001, 0.5), unit="of the size",
        tuned=(0.02, 0.1),
    )  # fmt: skip


REPORT_STANDING = "report"
IGNORE_STANDING = "ignore"


@dataclass(frozen=True, slots=True)
class BirthParameters:
    """Evidence that a new vehicle needs."""

    evidence: float = parameter(
        3.0, "Higher: a new vehicle is reported later, and fewer false ones are.",
        bounds=(0.0, 8.0), unit="log odds", tuned=(1.0, 6.0),
    )  # fmt: skip
    displacement: float = parameter(
        0.4, "Larger: unless its scores speak for it, a vehicle is reported after a longer drive.",
        bounds=(0.0, 10.0), unit="of the width", tuned=(0.1, 1.0),
    )  # fmt: skip
    standing: str = parameter(
        REPORT_STANDING,
        "What is done with vehicles that have not moved yet, of whose scores the detector is sure: "
        "report them, or ignore them until they drive. Counts at lines do not change.",
        choices=(REPORT_STANDING, IGNORE_STANDING),
    )  # fmt: skip


@dataclass(frozen=True, slots=True)
class TrafficParameters:
    """Parameters of `traffic`: of the tracker, its clock and its detector."""

    seed: int = parameter(
        0, "Seed of everything random; -1: another one in each run, which is reported.",
        bounds=(-1, 2**31 - 1), effect="restarts",
    )  # fmt: skip
    num_particles: int = parameter(
        50, "More: steadier where pixels alone hold a vehicle, at more time per frame.",
        bounds=(10, 10_000),
    )  # fmt: skip
    lost_after: float = parameter(
        2.0, "Longer: a hidden vehicle is predicted for longer before it is LOST.",
        bounds=(0.0, 60.0), unit="s",
    )  # fmt: skip
    forgotten_after: float = parameter(
        3.0, "Longer: a LOST vehicle keeps its number for longer, should it reappear.",
        bounds=(0.0, 600.0), unit="s",
    )  # fmt: skip
    pixels: bool = parameter(True, "Off: a vehicle that is not detected is only predicted.")
    occlusions: bool = parameter(
        True, "Off: vehicles are followed as if none could hide another; to compare."
    )
    returning: bool = parameter(
        True, "Off: a vehicle that reappears away from its prediction gets a new number."
    )
    motion: RoadMotionParameters = group(RoadMotionParameters)
    detections: DetectionParameters = group(DetectionParameters)
    birth: BirthParameters = group(BirthParameters)
    frame_rate: float = frame_rate_parameter()
    lines: str = parameter(
        "",
        "YAML of lines and zones to count at, and of regions of interest; empty: nothing is "
        "counted.",
        read_only=True,
    )  # fmt: skip
    page_port: int = parameter(
        -1,
        "Port of a page with picture and counts, for browsers of this machine; 0: any free one, "
        "-1: no page.",
        bounds=(-1, 65535), read_only=True,
    )  # fmt: skip
    detector: DetectorParameters = group(DetectorParameters)

    def validate(self) -> None:
        """Refuse a network without its file."""
        self.detector.validate()
