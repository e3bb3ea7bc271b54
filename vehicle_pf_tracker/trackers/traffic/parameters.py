# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Parameters of `traffic` and of its detector; docs/traffic.md has the model."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_pf_tracker.core.errors import InputError
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


@dataclass(frozen=True, slots=True)
class BirthParameters:
    """Evidence that a new vehicle needs."""

    evidence: float = parameter(
        3.0, "Higher: a new vehicle is reported later, and fewer false ones are.",
        bounds=(0.0, 8.0), unit="log odds", tuned=(1.0, 6.0),
    )  # fmt: skip
    displacement: float = parameter(
        0.4, "Larger: unless its scores speak for it, a vehicle is reported after a longer way.",
        bounds=(0.0, 10.0), unit="of the width", tuned=(0.1, 1.0),
    )  # fmt: skip


MOTION, MODEL, TOPIC, NONE = "motion", "model", "topic", "none"


@dataclass(frozen=True, slots=True)
class DetectorParameters:
    """Source of detections, and the network where it is one."""

    kind: str = parameter(
        MOTION,
        "Source of detections: what moves before a standing camera, a network of yours, a topic "
        "(of a node), or none (targets given by hand).",
        choices=(MOTION, MODEL, TOPIC, NONE), read_only=True,
    )  # fmt: skip
    model: str = parameter(
        "",
        "Network, .onnx: YOLOX, YOLOv8 or SSD by the form of its outputs. A file, or a URL that "
        "is fetched once; #sha256=… at its end demands this sum.",
        read_only=True,
    )  # fmt: skip
    classes: str = parameter(
        "car,motorcycle,bus,truck",
        "Classes of the network that are vehicles, by name or number, apart by commas; empty takes "
        "all.",
        read_only=True,
    )
    names: str = parameter(
        "",
        "Names of the network's classes in their order, apart by commas; empty takes those in the "
        "file, else COCO's.",
        read_only=True,
    )
    min_score: float = parameter(
        0.1, "Higher: fewer false alarms, more vehicles missed; the tracker itself weighs scores.",
        bounds=(0.0, 1.0), read_only=True,
    )  # fmt: skip
    overlap: float = parameter(
        0.65, "Higher: more of the boxes that overlap are kept, as intersection over union.",
        bounds=(0.05, 1.0), read_only=True,
    )  # fmt: skip
    input_size: int = parameter(
        640,
        "Longer side of the network's input where the file leaves it open; larger finds smaller "
        "vehicles, and takes longer.",
        bounds=(32, 4096), unit="px", read_only=True,
    )  # fmt: skip
    max_wait: float = parameter(
        0.5,
        "Longer: an image waits longer for its detections from a topic, and a detector that has "
        "stopped delays everything for longer.",
        bounds=(0.0, 60.0), unit="s",
    )  # fmt: skip
    every: int = parameter(
        1, "Above 1: the detector looks at every k-th image, and pixels hold vehicles in between; "
        "images do not wait for a topic's. 0: the smallest k that keeps the images' rate, which "
        "depends on the machine.",
        bounds=(0, 1000), unit="images",
    )  # fmt: skip

    def validate(self) -> None:
        """Refuse a network without its file."""
        if self.kind == MODEL and not self.model:
            raise InputError("detector.kind is model, and detector.model names no .onnx file")


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
