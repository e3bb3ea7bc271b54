# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Process of `versus.py` that steps the trackers of one version of the package.

It runs this file with any version, and so calls nothing but what all of them have: the registry,
parameters from a mapping, `start` and `step`. Requests are lists in JSON, one a line.
"""

from __future__ import annotations

import json
import sys
import time
from typing import Any

import cv2
import numpy as np

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.parameters.table import from_mapping
from vehicle_pf_tracker.trackers.registry import VARIANTS


class Steps:
    """A tracker on the frames of a file."""

    def __init__(self, path: str) -> None:
        with np.load(path) as read:
            self._frames = list(read["frames"])
            self._box = Box(*read["boxes"][0].tolist())
        self._tracker: Any = None

    def start(self, name: str, settings: dict[str, Any]) -> None:
        """Begin on the first frame; parameters that the variant has not are left out."""
        variant = VARIANTS[name]
        default = variant.parameters()
        known = {key: value for key, value in settings.items() if hasattr(default, key)}
        parameters = from_mapping(variant.parameters, known)
        self._tracker = variant.tracker(parameters)
        self._tracker.start(self._frames[0], self._box)

    def step(self, first: int, count: int) -> float:
        """Step through frames; seconds of this thread."""
        before = time.thread_time()
        for frame in self._frames[first : first + count]:
            self._tracker.step(frame)
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
