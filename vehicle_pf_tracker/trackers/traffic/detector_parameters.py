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

"""Parameters of where detections come from."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.table import group, parameter
from vehicle_pf_tracker.trackers.traffic.parameters import TrafficParameters

MOTION, MODEL, TOPIC, NONE = "motion", "model", "topic", "none"


@dataclass(frozen=True, slots=True)
class DetectorParameters:
    """Source of detections, and the network where it is one."""

    kind: str = parameter(
        MOTION,
        "Source of detections: what moves before a standing camera, a network of yours, a topic "
        "(of a node), or none (targets given by hand).",
        choices=(MOTION, MODEL, TOPIC, NONE),
        read_only=True,
    )
    model: str = parameter(
        "",
        "File of the network, .onnx: YOLOX, YOLOv8 or SSD by the form of its outputs.",
        read_only=True,
    )
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
        0.1,
        "Higher: fewer false alarms, more vehicles missed; the tracker itself weighs scores.",
        minimum=0.0,
        maximum=1.0,
        read_only=True,
    )
    overlap: float = parameter(
        0.65,
        "Higher: more of the boxes that overlap are kept, as intersection over union.",
        minimum=0.05,
        maximum=1.0,
        read_only=True,
    )
    input_size: int = parameter(
        640,
        "Longer side of the network's input where the file leaves it open; larger finds smaller "
        "vehicles, and takes longer.",
        minimum=32,
        maximum=4096,
        unit="px",
        read_only=True,
    )

    max_wait: float = parameter(
        0.5,
        "Longer: an image waits longer for its detections from a topic, and a detector that has "
        "stopped delays everything for longer.",
        minimum=0.0,
        maximum=60.0,
        unit="s",
    )
    every: int = parameter(
        1,
        "Above 1: the detector of a topic answers every k-th image, and the others do not wait.",
        minimum=1,
        maximum=1000,
        unit="images",
    )

    def validate(self) -> None:
        """Refuse a network without its file."""
        if self.kind == MODEL and not self.model:
            raise InputError("detector.kind is model, and detector.model names no .onnx file")


@dataclass(frozen=True, slots=True)
class TrafficRunParameters(TrafficParameters):
    """Parameters of the tracker of many vehicles with its clock and its detector."""

    frame_rate: float = parameter(
        0.0,
        "Nominal rate that speeds in px per frame refer to; 0 takes the median of the first ten "
        "intervals.",
        minimum=0.0,
        maximum=1000.0,
        unit="1/s",
    )
    lines: str = parameter(
        "",
        "YAML of lines and zones to count at; empty: nothing is counted.",
        read_only=True,
    )
    detector: DetectorParameters = group(DetectorParameters)

    def validate(self) -> None:
        """Refuse a network without its file."""
        self.detector.validate()
