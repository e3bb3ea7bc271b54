# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Clips that `fit` is given: each of a camera, with the boxes that the tracker gets."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.traffic.sequence import TrafficSequence, read_sequence


class Clip(NamedTuple):
    """A clip of a camera, with the boxes that the tracker is given."""

    camera: str
    sequence: TrafficSequence
    boxes: str


def read_clip(text: str, boxes: str) -> Clip:
    """Read a clip as the command line names it.

    Raises
    ------
    InputError
        If it has no camera's name, or no such boxes.
    """
    camera, equals, folder = text.partition("=")
    if not equals:
        raise InputError(f"{text} does not name a camera; give CAMERA=FOLDER")
    sequence = read_sequence(Path(folder))
    if boxes != "motion" and boxes not in sequence.detections:
        raise InputError(f"{folder} has no det/{boxes}.txt")
    return Clip(camera, sequence, boxes)
