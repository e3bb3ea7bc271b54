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

"""Measure every variant's steps on 4K images with a target of half the image.

    python -m benchmarks.large_targets

CPU time of the process, threads of libraries included, so that other work on the machine does not
count; on an idle core a step takes no longer.
"""

from __future__ import annotations

import argparse
import time

import cv2
import numpy as np

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.trackers.registry import VARIANTS, Variant

_STEP_PX = 6
"""Movement of the vehicle between two frames."""


def frames(width: int, height: int, share: float, count: int) -> tuple[list[Frame], Box]:
    """Make frames of a textured vehicle that moves right over a textured road."""
    rng = np.random.default_rng(3)
    road = _texture(rng, width, height, 90, 130)
    box = Box(width * (1 - share) / 2, height * (1 - share) / 2, width * share, height * share)
    x, y, w, h = (round(value) for value in (box.x, box.y, box.width, box.height))
    vehicle = _texture(rng, w, h, 20, 240)
    made = []
    for number in range(count):
        frame = road.copy()
        left = x + _STEP_PX * number
        frame[y : y + h, left : left + w] = vehicle
        made.append(frame)
    return made, Box(x, y, w, h)


def _texture(rng: np.random.Generator, width: int, height: int, low: int, high: int) -> Frame:
    small = rng.integers(low, high, (height // 24 + 1, width // 24 + 1, 3), np.uint8)
    large = cv2.resize(small, (width, height), interpolation=cv2.INTER_CUBIC)
    noise = rng.integers(0, 12, (height, width, 3), np.uint8)
    return np.asarray(cv2.add(large, noise), np.uint8)


def step_times(variant: Variant, images: list[Frame], box: Box) -> tuple[float, list[float]]:
    """CPU time in ms of the start, and of each step."""
    tracker = variant.tracker(variant.parameters())
    times = []
    for number, image in enumerate(images):
        began = time.process_time()
        if number == 0:
            tracker.start(image, box)
        else:
            tracker.step(image, 1.0)
        times.append(1e3 * (time.process_time() - began))
    return times[0], times[1:]


def main() -> None:
    """Measure the variants asked for and print a table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("variants", nargs="*", default=list(VARIANTS))
    parser.add_argument("--size", type=int, nargs=2, default=(3840, 2160), metavar=("W", "H"))
    parser.add_argument("--share", type=float, default=0.5, help="of the image's sides")
    parser.add_argument("--frames", type=int, default=30)
    args = parser.parse_args()
    cv2.setNumThreads(1)
    images, box = frames(*args.size, args.share, args.frames)
    print("| variant | start (ms) | step, median (ms) | step, longest (ms) |\n|---|---|---|---|")
    for name in args.variants:
        step_times(VARIANTS[name], images[:3], box)  # compiles
        start, steps = step_times(VARIANTS[name], images, box)
        cells = f"{start:.0f} | {np.median(steps):.0f} | {max(steps):.0f}"
        print(f"| `{name}` | {cells} |", flush=True)


if __name__ == "__main__":
    main()
