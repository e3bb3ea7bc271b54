# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Contrast of true boxes and of boxes thrown into their images, for doubts about targets.

python -m laboratory.target_contrast SEQUENCES
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import frame_size
from vehicle_pf_tracker.core.truth import Occlusion
from vehicle_pf_tracker.image.target_checks.target_pixels import LEAST_CONTRAST, contrast
from vehicle_pf_tracker.recordings.footage import Picture
from vehicle_pf_tracker.recordings.frame_folder import FrameFolder

EVERY = 10
"""Frames from one that is measured to the next: a vehicle changes little in between."""
THROWN = 5
"""Boxes of the true size thrown into each image, below its upper two fifths."""


def measured(folder: Path) -> tuple[list[float], list[float]]:
    """Return the contrasts of true boxes and of thrown ones in a sequence."""
    rng = np.random.default_rng(0)
    true = []
    thrown = []
    for index, picture in enumerate(FrameFolder(folder).frames()):
        if index % EVERY or not isinstance(picture, Picture):
            continue
        truth = picture.truth
        # A hidden vehicle's box shows something else.
        if truth is None or truth.occlusion is Occlusion.TOTAL:
            continue
        box = truth.box
        width, height = frame_size(picture.frame)
        true.append(contrast(picture.frame, box))
        # Below the upper two fifths, where sky and houses often are.
        top = min(0.4 * height, height - box.height)
        for _ in range(THROWN):
            x, y = rng.uniform(0, width - box.width), rng.uniform(top, height - box.height)
            thrown.append(contrast(picture.frame, Box(x, y, box.width, box.height)))
    return true, thrown


def main() -> None:
    """Print a row for each sequence."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("sequences", type=Path)
    print("| sequence | true boxes, least | median | thrown boxes below the limit |")
    print("| --- | ---: | ---: | ---: |")
    for path in sorted(parser.parse_args().sequences.glob("*/*/sequence.json")):
        true, thrown = measured(path.parent)
        share = float(np.mean(np.array(thrown) < LEAST_CONTRAST))
        print(f"| {path.parent.name} | {min(true):.1f} | {np.median(true):.1f} | {share:.2f} |")


if __name__ == "__main__":
    main()
