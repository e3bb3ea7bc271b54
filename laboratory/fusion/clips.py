# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Does `fusion` know that its vehicle has left? Clips without truth, with `traffic` in its place.

    python -m laboratory.fusion.clips CLIP... --model yolox_nano.onnx -o OUT

A clip is a video or a folder of images. `traffic` with the network says where vehicles are (kept in
``OUT``). `fusion` starts on up to eight of each clip that drive out of the image, and runs on after
that. A synthetic scene with twenty look-alikes each way comes last. ``clips.md`` has, by clip, the
frames on target while the vehicles were seen, and the share with `TRACKING` after they left.
Vehicles that only become too small for the network, or that wait at the border, are not judged:
looked at, many of them were still there, and followed.
"""

from __future__ import annotations

import argparse
import csv
import math
import sys
from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from laboratory.scenes import make_traffic_scene
from laboratory.scenes.traffic_scene import PX_PER_METRE, WIDTH
from laboratory.stress import variant_system
from vehicle_pf_tracker.cli.main import exit_status
from vehicle_pf_tracker.cli.main import main as run_command
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.evaluation.tables import markdown
from vehicle_pf_tracker.recordings.opened_footage import open_footage
from vehicle_pf_tracker.results.estimates import EstimateRow
from vehicle_pf_tracker.results.output_files import write_text
from vehicle_pf_tracker.results.traffic_results import TRACKS_FILE
from vehicle_pf_tracker.scenes.lane_traffic import CAR_PAINTS, Lane, Stage, convoy
from vehicle_pf_tracker.scenes.vehicles import saloon
from vehicle_pf_tracker.trackers.estimate import Estimate, Mode

MOST_VEHICLES = 8
"""Vehicles followed in a clip at most, a choice: each is another run of `fusion`."""
SURE, FEWEST = 0.55, 30
"""Score of the box that a vehicle is followed from, and fewest frames from there to its last."""
AFTER = 300
"""Frames that are judged after a vehicle has left."""
GRACE = 25
"""Frames after it was last seen in which a vehicle leaves, by its motion in as many before."""
AT_BORDER = 0.6
"""Distance of a centre from the border, of the size along it, within which a box is cut."""

SAME = 0.3
"""Overlap with a box of `traffic` from which that vehicle is claimed."""
FEW_CLAIMS = 0.02
"""Share with `TRACKING` that is wanted at most."""
HEAD = (
    "clip", "runs", "on target", "frames after leaving", "TRACKING there", "of these on others",
    "runs above .02",
)  # fmt: skip

Boxes = dict[int, dict[int, Box]]
"""Boxes of vehicles, by identity and by frame."""


class Clip(NamedTuple):
    """A clip: its images, its vehicles, and the frames in which these are sure, by identity."""

    name: str
    frames: Callable[[], Iterable[Frame | None]]
    boxes: Boxes
    sure: dict[int, set[int]]


@dataclass(eq=False)
class Run:
    """One vehicle followed by `fusion`: its frames, and what counts of them."""

    identity: int
    first: int
    last: int
    seed: int = 0
    seen: list[bool] = field(default_factory=list, init=False)
    claims: list[bool] = field(default_factory=list, init=False)
    others: int = field(default=0, init=False)

    @property
    def judged_from(self) -> int:
        """First frame after leaving that counts."""
        return self.last + GRACE

    def take(self, frame: int, estimate: Estimate | EstimateRow, boxes: Boxes) -> None:
        """Judge an estimate."""
        tracking = estimate.mode is Mode.TRACKING
        true = boxes[self.identity].get(frame)
        box = estimate.box
        assert box is not None
        # 1. While it is there: on target as everywhere, within half the diagonal.
        if frame <= self.last and true is not None:
            off = np.subtract(box.centre, true.centre)
            self.seen.append(bool(np.hypot(*off) < np.hypot(true.width, true.height) / 2))
        # 2. Long enough after it has left: any claim of TRACKING is wrong.
        elif frame > self.judged_from:
            self.claims.append(tracking)
            others = (own.get(frame) for own in boxes.values())
            self.others += tracking and any(
                other is not None and other.iou(box) > SAME for other in others
            )


def filmed(path: Path, model: str, output: Path) -> Clip:
    """Read a clip, and let `traffic` say where vehicles are, or read what it said before."""
    footage = open_footage(path)
    folder = output / path.stem
    # Read again where it is there: following a clip with a network takes minutes.
    if not (folder / TRACKS_FILE).exists():
        status = run_command(["traffic", str(path), "--model", model, "-o", str(folder)])
        if status:
            raise SystemExit(status)  # it has said why
    boxes: Boxes = defaultdict(dict)
    sure: dict[int, set[int]] = defaultdict(set)
    with (folder / TRACKS_FILE).open(newline="") as stream:
        for row in csv.DictReader(stream):
            score = float(row["score"] or "nan")
            if math.isnan(score):  # predicted
                continue
            identity = int(row["id"])
            # Rows count from 1, frames from 0.
            frame = int(row["frame"]) - 1
            x, y, width, height = (float(row[name]) for name in ("x", "y", "width", "height"))
            boxes[identity][frame] = Box.around((x, y), width, height)
            if score >= SURE:
                sure[identity].add(frame)
    return Clip(path.stem, lambda: (each.frame for each in footage.frames()), boxes, sure)


def look_alikes(frames: int = 600) -> Clip:
    """Make a road with cars of one kind and paint, of which some twenty drive each way."""
    rng = np.random.default_rng(0)
    actors = []
    # Two lanes, one each way, at 4 px a frame, so that some twenty pass each way.
    for lane in (
        Lane(100.0, PX_PER_METRE, rightward=True),
        Lane(175.0, PX_PER_METRE, rightward=False),
    ):
        actors += convoy(
            lane, 4.0, Stage(frames, WIDTH), rng, (60, 160), (lambda _: saloon(CAR_PAINTS[4]),)
        )
    # The camera and the road of any scene will do: its vehicles are replaced.
    scene = make_traffic_scene("traffic-pair", settings={"frames": frames})
    scene = replace(scene, vehicles=tuple(zip(actors[::2], actors[1::2], strict=True)))
    boxes: Boxes = defaultdict(dict)
    for frame in range(frames):
        for one in scene.truth(frame):
            boxes[one.identity][frame] = one.box
    return Clip("look-alikes", scene.images, boxes, {one: set(own) for one, own in boxes.items()})


def leaving(
    boxes: Boxes, sure: dict[int, set[int]], size: tuple[int, int], frames: int
) -> list[Run]:
    """Choose vehicles that leave well before the clip ends, evenly spread over it."""
    runs = []
    for identity, own in boxes.items():
        last = max(own)
        starts = [
            # A start on a box that is cut or shared would teach the tracker another vehicle.
            frame
            for frame in sorted(sure[identity])
            if is_free(identity, frame, boxes) and not is_at_border(own[frame], size)
        ]
        if not starts or last - starts[0] < FEWEST or last + GRACE + FEWEST > frames:
            continue
        # Judged by its motion: a vehicle that stops at the border has not left.
        before = own[min(frame for frame in own if frame >= last - GRACE)]
        out = 2 * np.array(own[last].centre) - before.centre  # where it is as much later
        outside = ((out < 0) | (out > size)).any()
        if outside and is_at_border(own[last], size):
            runs.append(Run(identity, starts[0], last))
    runs.sort(key=lambda run: run.first)
    chosen = np.unique(
        np.linspace(0, len(runs) - 1, min(MOST_VEHICLES, len(runs))).round().astype(int)
    )
    return [runs[number] for number in chosen]


def is_free(identity: int, frame: int, boxes: Boxes) -> bool:
    """Test whether no other box overlaps a vehicle's in a frame."""
    box = boxes[identity][frame]
    others = (own.get(frame) for other, own in boxes.items() if other != identity)
    return not any(other is not None and other.iou(box) > 0 for other in others)


def is_at_border(box: Box, size: tuple[int, int]) -> bool:
    """Test whether a box is about to leave an image of this width and height."""
    x, y = box.centre
    width, height = size
    return min(x, width - x) < AT_BORDER * box.width or min(y, height - y) < AT_BORDER * box.height


def followed(clip: Clip, seeds: int) -> list[Run]:
    """Follow vehicles of a clip that leave it, side by side."""
    # Decoded twice: the number of frames is known only at the end.
    sizes = [frame_size(frame) for frame in clip.frames() if frame is not None]
    chosen = leaving(clip.boxes, clip.sure, sizes[0], len(sizes))
    runs = [replace(run, seed=seed) for run in chosen for seed in range(seeds)]
    trackers = {}
    for number, frame in enumerate(clip.frames()):
        if frame is None:
            continue
        # Side by side, so that each image is decoded once for all of them.
        for run in runs:
            if number == run.first:
                trackers[run] = variant_system("fusion").make(run.seed)
                trackers[run].start(frame, clip.boxes[run.identity][number])
            elif run.first < number <= run.judged_from + AFTER:
                run.take(number, trackers[run].step(frame, 1.0), clip.boxes)
    return runs


def row(name: str, runs: Sequence[Run]) -> list[str]:
    """Row of the table: what was followed and claimed."""
    seen = [on for run in runs for on in run.seen]
    claims = [claim for run in runs for claim in run.claims]
    others = sum(run.others for run in runs)
    shares = (f"{share:.3f}" for share in (np.mean(claims), others / len(claims)))
    worst = sum(bool(np.mean(run.claims) > FEW_CLAIMS) for run in runs)
    first = [name, f"{len(runs)}", f"{np.mean(seen):.3f}", f"{len(claims)}"]
    return [*first, *shares, f"{worst}"]


def main() -> int:
    """Run, and write the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("clips", nargs="+", type=Path)
    parser.add_argument("--model", required=True, help="network of `traffic`, .onnx")
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("-o", "--output", type=Path, required=True)
    options = parser.parse_args()
    clips = [filmed(path, options.model, options.output) for path in options.clips]
    runs = [(clip.name, followed(clip, options.seeds)) for clip in (*clips, look_alikes())]
    table = [row(name, own) for name, own in runs if own]
    table.append(row("all", [run for _, own in runs for run in own]))
    write_text(options.output / "clips.md", markdown(HEAD, table))
    print(markdown(HEAD, table))
    return 0


if __name__ == "__main__":
    sys.exit(exit_status(main, "python -m laboratory.fusion.clips"))
