# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Clips that `fit` is given: each of a camera, with the boxes that the tracker gets."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.traffic.case_run import MOTION_SOURCE
from vehicle_pf_tracker.evaluation.traffic.sequence import TrafficSequence, read_sequence


class Clip(NamedTuple):
    """A clip of a camera, with the boxes that the tracker is given."""

    camera: str
    sequence: TrafficSequence
    boxes: str

    @property
    def given(self) -> tuple[TrafficSequence, str]:
        """The sequence with only the detections that are given, and their name."""
        return cut(self.sequence, self.boxes)


def read_clip(text: str, boxes: str) -> Clip:
    """Read a clip as the command line names it: CAMERA=FOLDER, or CAMERA=FOLDER=BOXES.

    Raises
    ------
    InputError
        If it has no camera's name, or no such boxes.
    """
    camera, equals, rest = text.partition("=")
    if not equals:
        raise InputError(f"{text} does not name a camera; give CAMERA=FOLDER")
    folder, _, own = rest.partition("=")
    clip = Clip(camera, read_sequence(Path(folder)), own or boxes)
    # Refused now, not after an hour of other clips.
    cut(clip.sequence, clip.boxes)
    return clip


def cut(sequence: TrafficSequence, boxes: str) -> tuple[TrafficSequence, str]:
    """Return a scene whose detections have scores from what the name says, and their name.

    Parameters
    ----------
    sequence : TrafficSequence
        The scene.
    boxes : str
        ``motion``, or a file of ``det/``; ``yolox_nano@.1`` has scores from .1.

    Raises
    ------
    InputError
        If there is no such file.
    """
    name, _, least = boxes.partition("@")
    if name != MOTION_SOURCE and name not in sequence.detections:
        raise InputError(f"{sequence.folder} has no det/{name}.txt")
    if not least:
        return sequence, name
    # Rows of MOTChallenge's detections: the sixth is the score.
    rows = sequence.detections[name]
    kept = {name: rows[rows[:, 5] >= float(least)]}
    return replace(sequence, detections=kept), name
