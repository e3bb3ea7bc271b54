# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Parameters of the source of detections."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.table import parameter

MOTION_DETECTOR = "motion"
MODEL_DETECTOR = "model"
TOPIC_DETECTOR = "topic"
NO_DETECTOR = "none"


@dataclass(frozen=True, slots=True)
class DetectorParameters:
    """Source of detections, and the network where it is one."""

    kind: str = parameter(
        MOTION_DETECTOR,
        "Source of detections: what moves before a standing camera, a network of yours, a topic "
        "(of a node), or none (targets given by hand).",
        choices=(MOTION_DETECTOR, MODEL_DETECTOR, TOPIC_DETECTOR, NO_DETECTOR), read_only=True,
    )  # fmt: skip
    model: str = parameter(
        "",
        "Network, .onnx: YOLOX, YOLOv8 or SSD by the form of its outputs. A file, or a URL that "
        "is fetched once; #sha256=… at its end demands this sum.",
        read_only=True,
    )  # fmt: skip
    classes: str = parameter(
        "car,bus,truck,motorcycle,bicycle",
        "Classes of the network that are followed, by name or number, apart by commas; empty takes "
        "all.",
        read_only=True,
    )
    apart: str = parameter(
        "motorcycle,bicycle",
        "Classes that have counts of their own and are in no total of vehicles, by name, apart by "
        "commas; empty: all are vehicles.",
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

    @property
    def classes_apart(self) -> frozenset[str]:
        """Names of the classes that are in no total of vehicles."""
        return frozenset(word.strip() for word in self.apart.split(",")) - {""}

    def validate(self) -> None:
        """Refuse a network without its file."""
        if self.kind == MODEL_DETECTOR and not self.model:
            raise InputError("detector.kind is model, and detector.model names no .onnx file")
