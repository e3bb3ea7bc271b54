# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Error of the speed on synthetic roads in perspective: the table of docs/road.md.

    python -m laboratory.road_speed --seeds 8 -o speeds.md

A car, a saloon or an SUV comes or goes at a constant speed, seen from a gantry or a mast, with or
without distortion; each seed has another camera. `fusion` starts on the first true box. The road is
given twice: by the camera's exact lens and pose, and by six pairs whose pixels are read off with an
error of half a pixel. Frames count from one second after the start on.
"""

from __future__ import annotations

import argparse
import statistics
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from laboratory.scenes.perspective import RoadCamera
from laboratory.scenes.road import RoadSceneParameters, camera_of, road
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.tables import NO_SCORE, markdown
from vehicle_pf_tracker.parameters.configuration import SessionParameters, TargetParameters
from vehicle_pf_tracker.parameters.road import RoadParameters, format_pairs
from vehicle_pf_tracker.parameters.table import from_mapping
from vehicle_pf_tracker.results.output_files import write_text
from vehicle_pf_tracker.road.plane import Pair
from vehicle_pf_tracker.trackers.localisation import Localisation
from vehicle_pf_tracker.trackers.registry import find_variant
from vehicle_pf_tracker.trackers.session import Session

SPEEDS = (20.0, 40.0, 60.0, 80.0, 100.0, 130.0)
"""Speeds of the drives, km/h: from a street in a town to a motorway."""
SETTLED = 1.0
"""Time from the start on after which the speed is judged, s."""
READING = 0.5
"""Standard deviation of the pixels of the pairs, px: points that a person reads off a picture."""
PLACES = ((-5.25, 20.0), (5.25, 20.0), (-5.25, 45.0), (5.25, 45.0), (-5.25, 75.0), (5.25, 75.0))
"""Road points of the pairs, m: on both edges of the road."""
HEADER = (
    "speed, km/h",
    "road from",
    "frames",
    "median error",
    "95 % of errors",
    "bias",
    "within 2 sd",
)


@dataclass(frozen=True, slots=True)
class Judged:
    """One frame: true and estimated speed, and its standard deviation, km/h."""

    true: float
    speed: float
    deviation: float

    @property
    def error(self) -> float:
        """Error as a share of the true speed."""
        return (self.speed - self.true) / self.true


def main() -> int:
    """Measure; 1 where a file cannot be written."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--seeds", type=int, default=8)
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--speeds", type=float, nargs="+", default=SPEEDS, metavar="KM/H")
    parser.add_argument("--variant", default="fusion")
    parser.add_argument("-o", "--output", type=Path, metavar="FILE.md")
    args = parser.parse_args()
    # One thread: steps are alike on every machine, whatever its cores.
    cv2.setNumThreads(1)
    try:
        seeds = range(args.first_seed, args.first_seed + args.seeds)
        table = _measure(args.variant, args.speeds, seeds)
        print(table, end="")
        if args.output:
            write_text(args.output, table)
    except InputError as error:
        print(f"road_speed: {error}", file=sys.stderr)
        return 1
    return 0


def _measure(variant: str, speeds: Sequence[float], seeds: Sequence[int]) -> str:
    rows: list[Sequence[str]] = []
    every: dict[str, list[Judged]] = {}
    for number, speed in enumerate(speeds):
        found: dict[str, list[Judged]] = {}
        for seed in seeds:
            settings = settings_of(speed, 5 * seed + number)
            for source, judged in judge(variant, settings, seed).items():
                found.setdefault(source, []).extend(judged)
            print(f"{speed:g} km/h, seed {seed}", file=sys.stderr, flush=True)
        for source, judged in found.items():
            every.setdefault(source, []).extend(judged)
            rows.append(_row(f"{speed:g}", source, judged))
    rows += [_row("all", source, judged) for source, judged in every.items()]
    return markdown(HEADER, rows)


def settings_of(speed: float, number: int) -> RoadSceneParameters:
    """Return the scene of this number: kinds, headings, mounts and lenses take turns.

    There are twelve combinations, and five from seed to seed leave none of them out at any speed.
    """
    # Periods of 2, 3, 4 and 6 in the number, so that all combinations come up.
    return RoadSceneParameters(
        speed=speed,
        vehicle=("car", "saloon", "suv")[number % 3],
        heading=("coming", "going")[number % 2],
        mount=("gantry", "mast")[number // 2 % 2],
        lens=("none", "barrel")[number // 3 % 2],
    )


def judge(variant: str, settings: RoadSceneParameters, seed: int) -> dict[str, list[Judged]]:
    """Track one scene with each way to give the road; returns the judged frames by that."""
    # Both roads see the same estimates: what they differ by is the road's error alone.
    roads = roads_of(camera_of(settings, seed), seed)
    places = {source: Localisation(variant, one) for source, one in roads.items()}
    session: Session | None = None
    judged: dict[str, list[Judged]] = {source: [] for source in roads}
    for each in road(settings, seed).frames():
        if session is None:
            session = _session(variant, each.truth.box, seed)
            start = each.truth.stamp_ns
        estimate = session.feed(each.frame, each.truth.stamp_ns)
        assert estimate is not None
        for source, place in places.items():
            place.follow(estimate, each.truth.stamp_ns, session.tracker.frame_period)
            # A speed needs some frames: at the start there is only one position.
            if place.road is not None and each.truth.stamp_ns - start >= SETTLED * 1e9:
                found = place.road
                judged[source].append(Judged(settings.speed, found.speed, found.speed_deviation))
    return judged


def _session(variant: str, box: Box, seed: int) -> Session:
    kind = find_variant(variant)
    target = TargetParameters(box.x, box.y, box.width, box.height)
    parameters = from_mapping(kind.parameters, {"seed": seed})
    return Session(kind, parameters, SessionParameters(target=target))


def roads_of(camera: RoadCamera, seed: int) -> Mapping[str, RoadParameters]:
    """Return the parameters of the road: exact, and by pairs that were read off."""
    lens = camera.lens
    values: dict[str, Any] = {
        "intrinsics": ",".join(map(repr, (*lens.focal, *lens.centre))),
        "distortion_model": lens.model,
        "distortion": ",".join(map(repr, lens.coefficients)),
    }
    # Where the points are in the image, and where a person would click.
    pixels = camera.plane.to_image(np.array(PLACES))
    read = pixels + np.random.default_rng(seed).normal(scale=READING, size=pixels.shape)
    pairs = tuple(Pair((u, v), place) for (u, v), place in zip(read.tolist(), PLACES, strict=True))
    pose = camera.pose
    numbers = (*pose.position.tolist(), *quaternion(pose.rotation))
    return {
        "camera": RoadParameters(camera_pose=",".join(map(repr, numbers)), **values),
        "pairs": RoadParameters(pairs=format_pairs(pairs), **values),
    }


def quaternion(rotation: np.ndarray) -> tuple[float, float, float, float]:
    """Return the unit quaternion (x, y, z, w) of a rotation matrix (3, 3)."""
    # The eigenvector of the largest eigenvalue of this matrix (Bar-Itzhack 2000) is the quaternion.
    (a, b, c), (d, e, f), (g, h, i) = rotation
    matrix = np.array(
        [
            [a - e - i, b + d, c + g, h - f],
            [b + d, e - a - i, f + h, c - g],
            [c + g, f + h, i - a - e, d - b],
            [h - f, c - g, d - b, a + e + i],
        ]
    )
    x, y, z, w = np.linalg.eigh(matrix)[1][:, -1].tolist()
    return x, y, z, w


def _row(speed: str, source: str, judged: Sequence[Judged]) -> list[str]:
    if not judged:
        return [speed, source, "0", *[NO_SCORE] * 4]
    errors = [one.error for one in judged]
    sizes = [abs(error) for error in errors]
    # Two standard deviations should hold 95 %.
    within = [abs(one.speed - one.true) <= 2 * one.deviation for one in judged]
    return [
        speed,
        source,
        str(len(judged)),
        f"{100 * statistics.median(sizes):.2f} %",
        f"{100 * float(np.quantile(sizes, 0.95)):.2f} %",
        f"{100 * statistics.fmean(errors):+.2f} %",
        f"{100 * statistics.fmean(within):.0f} %",
    ]


if __name__ == "__main__":
    sys.exit(main())
