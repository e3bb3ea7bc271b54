"""Run one of OpenCV's trackers on a frame folder: a box per frame as CSV, for `sequences.py`.

It runs in an environment of its own, since OpenCV's contrib package and ours overwrite each other.
"""

from __future__ import annotations

import csv
import json
import sys
from pathlib import Path

import cv2

TRACKERS = {
    "csrt": "TrackerCSRT_create",
    "kcf": "TrackerKCF_create",
    "mil": "TrackerMIL_create",
}


def main(folder: Path, name: str) -> None:
    """Track from the first box on; a frame that the tracker gives up keeps the box before it."""
    first = json.loads((folder / "sequence.json").read_text())["first_box"]
    box = tuple(round(side) for side in first)
    writer = csv.writer(sys.stdout)
    tracker = None
    for path in sorted((folder / "img").iterdir()):
        image = cv2.imread(str(path))
        if tracker is None:
            tracker = getattr(cv2, TRACKERS[name])()
            tracker.init(image, box)
        else:
            found, new = tracker.update(image)
            box = new if found else box
        writer.writerow(box)


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2])
