# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Time per frame and memory of `traffic` with many vehicles, beside ByteTrack and OC-SORT.

    python -m benchmarks.traffic_cost

One thread. The same 640x360 px images with 10, 20 and 50 vehicles at once are followed in turns:
`traffic` with given boxes, `traffic` that finds them itself, and the baselines on those boxes.
Times are processor times; the medians of the rounds are shown. Then a detector that is out of
order: so many boxes in every image that drive, or are anywhere.
"""

from __future__ import annotations

import argparse
import statistics
import subprocess
import sys
import tempfile
import time
from functools import partial
from pathlib import Path

import cv2
import numpy as np

from laboratory.scenes.mot_folder import write_mot_folder
from laboratory.scenes.traffic_scene import TrafficScene
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.detection.motion_detector import MotionDetector
from vehicle_pf_tracker.evaluation.traffic.baselines import TrafficWorker
from vehicle_pf_tracker.evaluation.traffic.sequence import TrafficSequence, read_sequence
from vehicle_pf_tracker.scenes.cameras import Camera
from vehicle_pf_tracker.scenes.lane_traffic import any_car
from vehicle_pf_tracker.scenes.random_streams import stream
from vehicle_pf_tracker.scenes.roads import Carriageway, countryside
from vehicle_pf_tracker.trackers.traffic.estimate import TrackMode
from vehicle_pf_tracker.trackers.traffic.parameters import TrafficParameters
from vehicle_pf_tracker.trackers.traffic.session import TrafficSession
from vehicle_pf_tracker.trackers.traffic.tracker import MultiVehicleTracker

COUNTS = (10, 20, 50)
"""Vehicles at once: a road, a dual carriageway, a jam."""
WIDTH = 640
HEIGHT = 360
"""Size of the images in px, the smaller one that traffic cameras send."""
FRAMES = 200
"""Images of a scene: 140 of them are timed."""
SETTLED = 60
"""First frames, in which the background is learnt and vehicles are found; not timed."""
BEYOND = 45
"""Distance outside of the image from which vehicles come back on the other side, px."""
FLOODS = (1500, 50_000)
"""Boxes in an image of a detector that is out of order."""
BASELINES = ("bytetrack", "ocsort")
"""Trackers that follow boxes alone, beside which the cost is shown."""


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--counts", type=int, nargs="+", default=COUNTS, help="vehicles at once")
    parser.add_argument(
        "--frames", type=int, default=FRAMES, help=f"images of a scene, more than {SETTLED}"
    )
    parser.add_argument("--resident", type=Path, help=argparse.SUPPRESS)
    args = parser.parse_args()
    cv2.setNumThreads(1)
    if args.resident:
        resident(read_sequence(args.resident))
        return
    with tempfile.TemporaryDirectory() as folder, TrafficWorker() as worker:
        counts = args.counts
        sequences = {count: made(count, Path(folder, str(count)), args.frames) for count in counts}
        print(
            "| vehicles | traffic, boxes given | traffic, motion | bytetrack | ocsort | followed |"
        )
        print("|---:|---:|---:|---:|---:|---:|")
        means = {count: row(count, sequences[count], worker, args.rounds) for count in counts}
        span = counts[-1] - counts[0]
        slopes = np.subtract(means[counts[-1]][:2], means[counts[0]][:2]) / span
        print(f"\nper further vehicle: {slopes[0]:.2f} ms, with motion {slopes[1]:.2f} ms\n")
        for boxes in FLOODS:
            print(f"{boxes} boxes in an image: {flood(boxes, args.frames // 5):.0f} ms")
        sys.stdout.flush()
        command = [sys.executable, "-m", "benchmarks.traffic_cost", "--resident"]
        subprocess.run([*command, str(sequences[counts[-1]].folder)], check=True)


def made(count: int, folder: Path, frames: int = FRAMES) -> TrafficSequence:
    """Render a scene that shows about `count` vehicles all the time, and read it again."""
    roads = (
        Carriageway(60, 4, 7.0, rightward=True),
        Carriageway(190, 4, 7.0, rightward=False),
    )
    rng = stream(0, "cost")
    vehicles = []
    ring = WIDTH + 2 * BEYOND
    total = round(count * ring / WIDTH)
    for number in range(total):
        road = roads[number % 2]
        lane = road.lane(number // 2 % 4)
        vehicle = any_car(lane, rng)
        speed = 1.7 + 0.1 * (number % 8)
        start = ring * (number // 8 + number % 8 / 8) / (total / 8)
        path = partial(place, vehicle.box(0.0, lane), start, speed if road.rightward else -speed)
        vehicles.append(vehicle.on(path))
    scene = TrafficScene(
        width=WIDTH,
        height=HEIGHT,
        frame_rate=30.0,
        frame_count=frames,
        backdrop=lambda: countryside((HEIGHT, WIDTH), roads, stream(0, "backdrop")),
        vehicles=tuple(vehicles),
        obstacles=(),
        camera=Camera(2.0, 0),
    )
    write_mot_folder(scene, folder, 0)
    return read_sequence(folder)


def place(box: Box, start: float, speed: float, frame: float) -> Box:
    """Drive across the image, and again."""
    x = (start + speed * frame) % (WIDTH + 2 * BEYOND) - BEYOND
    return Box(x, box.y, box.width, box.height)


def row(
    count: int, sequence: TrafficSequence, worker: TrafficWorker, rounds: int
) -> tuple[float, ...]:
    """Print and return the times for one number of vehicles, ms."""
    boxes = sequence.detections["good"]
    found: dict[str, list[float]] = {}
    followed = 0.0
    for _ in range(rounds):
        given, followed = ours(sequence, motion=False)
        found.setdefault("given", []).append(given)
        found.setdefault("motion", []).append(ours(sequence, motion=True)[0])
        for name in BASELINES:
            found.setdefault(name, []).append(1e3 * worker.track(name, sequence, boxes)[1])
    times = tuple(statistics.median(values) for values in found.values())
    print(f"| {count} |", " | ".join(f"{ms:.1f} ms" for ms in times), f"| {followed:.0f} |")
    return times


def ours(sequence: TrafficSequence, *, motion: bool) -> tuple[float, float]:
    """Return the mean time of a settled frame in ms, and the mean number of vehicles followed."""
    session = TrafficSession(
        MultiVehicleTracker(TrafficParameters()),
        MotionDetector if motion else None,
        frame_rate=30.0,
    )
    rows = sequence.detections["good"]
    seconds = []
    followed = []
    for number, frame in enumerate(sequence.frames(), start=1):
        now = rows[rows[:, 0] == number]
        detections = None if motion else Detections.make(now[:, 1:5], now[:, 5])
        before = time.process_time()
        estimates = session.feed(frame, round(number * 1e9 / 30), detections)
        seconds.append(time.process_time() - before)
        followed.append(sum(estimate.mode is TrackMode.TRACKING for estimate in estimates))
    return 1e3 * statistics.fmean(seconds[SETTLED:]), statistics.fmean(followed[SETTLED:])


def flood(count: int, frames: int) -> float:
    """Return the mean time in ms of an image with so many boxes, a half of which drive."""
    rng = stream(0, "flood")
    tracker = MultiVehicleTracker(TrafficParameters())
    image = np.zeros((HEIGHT, WIDTH, 3), np.uint8)
    driving = rng.uniform((0, 0, 8, 8), (WIDTH, HEIGHT, 40, 40), (count // 2, 4))
    seconds = []
    for _ in range(frames):
        driving[:, 0] = (driving[:, 0] + 2) % WIDTH
        anywhere = rng.uniform((0, 0, 8, 8), (WIDTH, HEIGHT, 60, 60), (count - count // 2, 4))
        boxes = Detections.make(np.vstack([driving, anywhere]), rng.uniform(size=count))
        before = time.process_time()
        tracker.step(image, boxes)
        seconds.append(time.process_time() - before)
    return 1e3 * statistics.fmean(seconds)


def resident(sequence: TrafficSequence) -> None:
    """Print the memory of this process before and after following what moves."""
    before = resident_mb()
    ours(sequence, motion=True)
    print(f"memory with most vehicles: {resident_mb():.0f} MB, of which imports {before:.0f}")


def resident_mb() -> float:
    """Memory that this process holds, MB."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * 4096 / 1e6


if __name__ == "__main__":
    main()
