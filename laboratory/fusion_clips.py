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

"""Does `fusion` know that its vehicle has left? Clips without truth, with `traffic` in its place.

    python -m laboratory.fusion_clips CLIP... --model yolox_nano.onnx -o OUT

`traffic` with the network says where vehicles are (kept in ``OUT``). `fusion` starts on up to eight
of each clip that drive out of the image, and runs on after that. ``clips.md`` has, by clip, the
frames on target while `traffic` saw them, and the share with `TRACKING` after they left. Vehicles
that only become too small for the network, or that wait at the border, are not judged: looked at,
many of them were still there, and followed.
"""

from __future__ import annotations

import argparse
import csv
import math
import sys
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path

import numpy as np

from laboratory.stress import variant_system
from vehicle_pf_tracker.cli.main import main as run_command
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import frame_size
from vehicle_pf_tracker.evaluation.tables import markdown
from vehicle_pf_tracker.offline.estimates import EstimateRow
from vehicle_pf_tracker.offline.output_files import write_text
from vehicle_pf_tracker.offline.traffic_results import TRACKS
from vehicle_pf_tracker.recordings.video import VideoFile
from vehicle_pf_tracker.trackers.estimate import Estimate, Mode

MOST = 8
"""Vehicles of a clip."""
SURE, FEWEST = 0.55, 30
"""Score of the box that a vehicle is followed from, and fewest frames from there to its last."""
AFTER = 250
"""Frames that are judged after a vehicle has left."""
GRACE = 25
"""Frames after it was last seen in which a vehicle leaves, by its motion in as many before."""
AT_BORDER = 0.6
"""Distance of a centre from the border, of the size along it, within which a box is cut."""

SAME = 0.3
"""Overlap with a box of `traffic` from which that vehicle is claimed."""
FEW_CLAIMS = 0.02
"""Share with `TRACKING` that is wanted at most."""
HEAD = ("clip", "runs", "on target", "TRACKING after leaving", "of these on others", "above .02")

Boxes = dict[int, dict[int, Box]]
"""Boxes of what `traffic` sees, by identity and by frame."""


@dataclass(eq=False)
class Run:
    """One vehicle followed by `fusion`: its frames, and what counts of them."""

    identity: int
    first: int
    last: int
    seed: int = 0
    seen: list[bool] = field(default_factory=list)
    claims: list[bool] = field(default_factory=list)
    others: int = 0

    @property
    def judged_from(self) -> int:
        """First frame after leaving that counts."""
        return self.last + GRACE

    def take(self, frame: int, estimate: Estimate | EstimateRow, boxes: Boxes) -> None:
        """Judge an estimate."""
        tracking, true = estimate.mode is Mode.TRACKING, boxes[self.identity].get(frame)
        box = estimate.box
        assert box is not None
        if frame <= self.last and true is not None:
            off = np.subtract(box.centre, true.centre)
            self.seen.append(bool(np.hypot(*off) < np.hypot(true.width, true.height) / 2))
        elif frame > self.judged_from:
            self.claims.append(tracking)
            others = (own.get(frame) for own in boxes.values())
            self.others += tracking and any(
                other is not None and other.iou(box) > SAME for other in others
            )


def seen_by_traffic(clip: Path, model: str, folder: Path) -> tuple[Boxes, dict[int, set[int]]]:
    """Boxes that `traffic` sees in a clip, and the frames in which they are sure, by identity."""
    if not (folder / TRACKS).exists():
        status = run_command(["traffic", str(clip), "--model", model, "-o", str(folder)])
        if status:
            raise InputError(f"traffic on {clip} ended with status {status}")
    boxes: Boxes = defaultdict(dict)
    sure: dict[int, set[int]] = defaultdict(set)
    with (folder / TRACKS).open(newline="") as stream:
        for row in csv.DictReader(stream):
            score = float(row["score"] or "nan")
            if math.isnan(score):  # predicted
                continue
            identity, frame = int(row["id"]), int(row["frame"]) - 1
            x, y, width, height = (float(row[name]) for name in ("x", "y", "width", "height"))
            boxes[identity][frame] = Box.around((x, y), width, height)
            if score >= SURE:
                sure[identity].add(frame)
    return boxes, sure


def leaving(
    boxes: Boxes, sure: dict[int, set[int]], size: tuple[int, int], frames: int
) -> list[Run]:
    """Choose vehicles that leave well before the clip ends, evenly spread over it."""
    runs = []
    for identity, own in boxes.items():
        last = max(own)
        starts = [
            frame for frame in sorted(sure[identity])
            if is_free(identity, frame, boxes) and not is_at_border(own[frame], size)
        ]  # fmt: skip
        if not starts or last - starts[0] < FEWEST or last + GRACE + FEWEST > frames:
            continue
        before = own[min(frame for frame in own if frame >= last - GRACE)]
        out = 2 * np.array(own[last].centre) - before.centre  # where it is as much later
        outside = ((out < 0) | (out > size)).any()
        if outside and is_at_border(own[last], size):
            runs.append(Run(identity, starts[0], last))
    runs.sort(key=lambda run: run.first)
    chosen = np.unique(np.linspace(0, len(runs) - 1, min(MOST, len(runs))).round().astype(int))
    return [runs[number] for number in chosen]


def is_free(identity: int, frame: int, boxes: Boxes) -> bool:
    """Test whether no other box overlaps a vehicle's in a frame."""
    box = boxes[identity][frame]
    others = (own.get(frame) for other, own in boxes.items() if other != identity)
    return not any(other is not None and other.iou(box) > 0 for other in others)


def is_at_border(box: Box, size: tuple[int, int]) -> bool:
    """Test whether a box is about to leave an image of this width and height."""
    (x, y), (width, height) = box.centre, size
    return (
        min(x, width - x) < AT_BORDER * box.width or min(y, height - y) < AT_BORDER * box.height
    )  # fmt: skip


def followed(clip: Path, boxes: Boxes, runs: Sequence[Run]) -> None:
    """Follow the vehicles of all runs through a clip, side by side."""
    trackers = {}
    for number, picture in enumerate(VideoFile(clip).frames()):
        for run in runs:
            if number == run.first:
                trackers[run] = variant_system("fusion").make(run.seed)
                trackers[run].start(picture.frame, boxes[run.identity][number])
            elif run.first < number <= run.judged_from + AFTER:
                run.take(number, trackers[run].step(picture.frame, 1.0), boxes)


def row(name: str, runs: Sequence[Run]) -> list[str]:
    """Row of the table: what was followed and claimed."""
    seen = [on for run in runs for on in run.seen]
    claims = [claim for run in runs for claim in run.claims]
    others = sum(run.others for run in runs)
    shares = np.mean(seen), np.mean(claims), others / len(claims)
    worst = sum(bool(np.mean(run.claims) > FEW_CLAIMS) for run in runs)
    return [name, f"{len(runs)}", *(f"{share:.3f}" for share in shares), f"{worst}"]


def main() -> int:
    """Run, and write the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("clips", nargs="+", type=Path)
    parser.add_argument("--model", required=True, help="network of `traffic`, .onnx")
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("-o", "--output", type=Path, required=True)
    options = parser.parse_args()
    table: list[list[str]] = []
    all_runs: list[Run] = []
    for clip in options.clips:
        boxes, sure = seen_by_traffic(clip, options.model, options.output / clip.stem)
        pictures = list(islice(VideoFile(clip).frames(), 1))
        frames = sum(1 for _ in VideoFile(clip).frames())
        chosen = leaving(boxes, sure, frame_size(pictures[0].frame), frames)
        runs = [
            Run(run.identity, run.first, run.last, seed)
            for run in chosen
            for seed in range(options.seeds)
        ]
        followed(clip, boxes, runs)
        if runs:
            table.append(row(clip.stem, runs))
        all_runs += runs
    if not all_runs:
        raise InputError("no vehicle leaves these clips early enough; give others")
    table.append(row("all", all_runs))
    write_text(options.output / "clips.md", markdown(HEAD, table))
    print(markdown(HEAD, table))
    return 0


if __name__ == "__main__":
    sys.exit(main())
