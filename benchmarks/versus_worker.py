# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Process of `versus.py` that steps the trackers of one version of the package.

It runs this file with any version, and so calls nothing but what all of them have: the registry,
parameters from a mapping, `start` and `step`; and the tracker of many vehicles, which old versions
may have elsewhere, only where it is asked for. Requests are lists in JSON, one a line.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from typing import Any

import cv2
import numpy as np

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.parameters.table import from_mapping
from vehicle_pf_tracker.trackers.registry import VARIANTS


class Steps:
    """A tracker on the frames of a file, or of another one that is named when it starts."""

    def __init__(self, path: str) -> None:
        with np.load(path) as read:
            self._frames = list(read["frames"])
            self._box = Box(*read["boxes"][0].tolist())
        self._step: Callable[[int], object] | None = None

    def start(self, name: str, settings: dict[str, Any]) -> None:
        """Begin on the first frame; parameters that the variant has not are left out."""
        variant = VARIANTS[name]
        default = variant.parameters()
        known = {key: value for key, value in settings.items() if hasattr(default, key)}
        parameters = from_mapping(variant.parameters, known)
        tracker = variant.tracker(parameters)
        tracker.start(self._frames[0], self._box)
        self._step = lambda index: tracker.step(self._frames[index])

    def start_traffic(self, path: str, settled: int) -> None:
        """Follow all vehicles of another file through its first frames."""
        from vehicle_pf_tracker.detection.detections import Detections  # noqa: PLC0415
        from vehicle_pf_tracker.trackers.traffic.tracker import MultiVehicleTracker  # noqa: PLC0415

        with np.load(path) as read:
            frames = list(read["frames"])
            rows = read["boxes"]
        numbers = range(1, len(frames) + 1)
        of_frames = [rows[rows[:, 0] == number] for number in numbers]
        found = [Detections.make(here[:, 1:5], here[:, 5]) for here in of_frames]
        tracker = MultiVehicleTracker()
        self._step = lambda index: tracker.step(frames[index], found[index])
        for index in range(settled):
            self._step(index)

    def step(self, first: int, count: int) -> float:
        """Step through frames; seconds of this thread."""
        assert self._step is not None
        before = time.thread_time()
        for index in range(first, first + count):
            self._step(index)
        return time.thread_time() - before


def main() -> None:
    """Answer requests until there are no more."""
    cv2.setNumThreads(1)
    steps = Steps(sys.argv[1])
    for line in sys.stdin:
        word, *values = json.loads(line)
        answer = list(VARIANTS) if word == "variants" else getattr(steps, word)(*values)
        print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    main()
