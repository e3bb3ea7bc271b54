# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The tracker of many vehicles and baselines on the same detections of scenes with truth.

The report of a comparison is Markdown, CSV and JSON.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, astuple, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.detection.detector import FollowedVehicle
from vehicle_pf_tracker.detection.motion_detector import MotionDetector
from vehicle_pf_tracker.evaluation.tables import NO_SCORE, Rows, markdown
from vehicle_pf_tracker.evaluation.traffic.line_counts import LineCounts, held_and_width
from vehicle_pf_tracker.evaluation.traffic.scoring import (
    TRAFFIC_BASELINES,
    TrafficWorker,
    counts,
    kept_identities,
)
from vehicle_pf_tracker.evaluation.traffic.sequence import TrafficSequence
from vehicle_pf_tracker.results.backdating import Backdating, Frames
from vehicle_pf_tracker.results.output_files import make_folder, write_csv, write_json, write_text
from vehicle_pf_tracker.results.run_folder import versions
from vehicle_pf_tracker.results.traffic_results import IN_TRACKS
from vehicle_pf_tracker.trackers.traffic.parameters import TrafficParameters
from vehicle_pf_tracker.trackers.traffic.session import TrafficSession
from vehicle_pf_tracker.trackers.traffic.tracker import MultiVehicleTracker

OURS = "traffic"
"""Name of our system among the others."""
MOTION = "motion"
"""Source of detections: the embedded detector, whose boxes the baselines get too."""

Maker = Callable[[TrafficParameters], MultiVehicleTracker]
Case = tuple[TrafficSequence, str]
"""A scene with truth, and a key of its detections or `MOTION`."""


@dataclass(frozen=True, slots=True)
class TrafficResult:
    """Result of one system in one case, or the mean of several runs.

    Attributes
    ----------
    scene, source, system : str
        Name of the scene, source of detections, and `OURS` or a baseline.
    seed : int or None
        Seed; None for a baseline or a mean.
    values : dict of str to float
        TrackEval's scores by name. ``kept``, percent of total occlusions with the same identity
        afterwards, and ``count_error``, percent of the true crossings of the middle line, where
        there are any. ``held`` and ``width``, percent of the lines' intervals that hold the true
        count, and their mean width. ``step_ms``, mean processor time per frame; without detection,
        except for `MOTION`.
    occlusions, true : int
        Total occlusions that are judged, and true crossings.
    runs : int
        Number of runs.
    """

    scene: str
    source: str
    system: str
    seed: int | None
    values: dict[str, float]
    occlusions: int
    true: int
    runs: int = 1


def cases_of(
    sequences: Sequence[TrafficSequence], sources: Sequence[str] | None = None
) -> list[Case]:
    """List the cases: each scene with each of its detections and `MOTION`, or with `sources`."""
    return [
        (sequence, source)
        for sequence in sequences
        for source in (*sequence.detections, MOTION)
        if sources is None or source in sources
    ]


def compare(
    cases: Sequence[Case],
    worker: TrafficWorker,
    parameters: TrafficParameters,
    seeds: Sequence[int],
    *,
    baselines: Sequence[str] = tuple(TRAFFIC_BASELINES),
    make: Maker = MultiVehicleTracker,
    on_progress: Callable[[int, int], None] = lambda done, total: None,
) -> Iterator[TrafficResult]:
    """Run all systems on all cases, one after the other.

    Parameters
    ----------
    cases : sequence of Case
        Scenes and detections to run on.
    worker : TrafficWorker
        Runs the baselines and scores.
    parameters : TrafficParameters
        Parameters of the tracker; the seed is replaced.
    seeds : sequence of int
        Seeds of the tracker, at least one.
    baselines : sequence of str
        Keys of `TRAFFIC_BASELINES`.
    make : callable
        Makes the tracker.
    on_progress : callable
        Called with the number of frames done and of all.
    """
    total = sum(sequence.frame_count for sequence, _ in cases)
    done = 0
    for case in cases:
        given: list[Array] = []
        for seed in seeds:
            lines = LineCounts(case[0])
            own = replace(parameters, seed=seed)
            tracks, detections, seconds = follow(case, own, make, lines)
            # What moved depends on the tracks, and so on the seed; the baselines get what the
            # first had.
            given.append(detections)
            result = judge(case, worker, OURS, seed, (tracks, seconds))
            if (trust := held_and_width(lines.results())) is not None:
                result.values["held"], result.values["width"] = trust
            yield result
        for name in baselines:
            yield judge(case, worker, name, None, worker.track(name, case[0], given[0]))
        done += case[0].frame_count
        on_progress(done, total)


def judge(
    case: Case, worker: TrafficWorker, system: str, seed: int | None, run: tuple[Array, float]
) -> TrafficResult:
    """Score one run: its tracks, and processor time per frame in s."""
    sequence, source = case
    tracks, seconds = run
    values = worker.score(sequence, tracks)
    kept, occlusions = kept_identities(sequence, tracks)
    counted, true = counts(sequence, tracks)
    if occlusions:
        values["kept"] = 100 * kept / occlusions
    if true:
        values["count_error"] = 100 * (counted / true - 1)
    values["step_ms"] = 1e3 * seconds
    return TrafficResult(sequence.name, source, system, seed, values, occlusions, true)


class _Recorder(MotionDetector):
    """Keeps frame, left, top, width, height and score of all that moved."""

    def __init__(self) -> None:
        super().__init__()
        self.rows: list[Array] = []

    def detect(self, frame: Frame, tracks: Sequence[FollowedVehicle] = ()) -> Detections:
        """Find what moves."""
        found = super().detect(frame, tracks)
        numbers = np.full(len(found.scores), len(self.rows) + 1)
        self.rows.append(np.column_stack([numbers, found.boxes, found.scores]))
        return found


def follow(
    case: Case,
    parameters: TrafficParameters,
    make: Maker = MultiVehicleTracker,
    lines: LineCounts | None = None,
) -> tuple[Array, Array, float]:
    """Follow all vehicles of a case with the tracker, and count them at `lines` on the way.

    Returns
    -------
    tracks : array, shape (N, 6)
        Frame, identity, left, top, width and height of tracked and occluded vehicles.
    detections : array, shape (M, 6)
        Frame, left, top, width, height, score of what the tracker was given.
    seconds : float
        Processor time per frame, s.
    """
    sequence, source = case
    recorder = _Recorder()
    given = None if source == MOTION else sequence.detections[source]
    detector = (lambda: recorder) if given is None else None
    session = TrafficSession(make(parameters), detector, frame_rate=sequence.frame_rate)
    tracks: list[list[float]] = []
    backdating = Backdating()
    seconds = 0.0
    for number, frame in enumerate(sequence.frames(), start=1):
        detections = None
        if given is not None:
            # Before the clock starts: a baseline is not charged for it either.
            now = given[given[:, 0] == number]
            detections = Detections.make(now[:, 1:5], now[:, 5])
        # CPU of the whole process: the detector may use several threads.
        before = time.process_time()
        stamp_ns = round(number * 1e9 / sequence.frame_rate)
        estimates = session.feed(frame, stamp_ns, detections)
        seconds += time.process_time() - before
        if lines is not None:
            lines.add(number, stamp_ns, session)
        tracks += _rows(backdating.add(number, 0, estimates))
    # Vehicles that are confirmed late get the rows of before, as in `tracks.txt`.
    tracks += _rows(backdating.rest())
    rows = np.array(tracks, dtype=np.float64).reshape(-1, 6)
    detected = np.vstack(recorder.rows) if given is None else given
    return rows, detected, seconds / sequence.frame_count


def _rows(frames: Frames) -> list[list[float]]:
    return [
        [number, one.identity, *astuple(one.box)]
        for number, _, estimates in frames
        for one in estimates
        if one.mode in IN_TRACKS
    ]


NAME = "traffic"
"""Name of the files without their suffix."""

COLUMNS: Mapping[str, tuple[str, int]] = {
    "HOTA": ("HOTA", 1),
    "DetA": ("DetA", 1),
    "AssA": ("AssA", 1),
    "IDF1": ("IDF1", 1),
    "MOTA": ("MOTA", 1),
    "IDSW": ("switches", 1),
    "Frag": ("fragm.", 1),
    "kept": ("identity kept", 0),
    "count_error": ("count error", 1),
    "held": ("held", 0),
    "width": ("width", 1),
    "step_ms": ("ms", 1),
}
"""Measures, with their headings and decimals."""

# Words below the table.
RULES = """\
HOTA, DetA, AssA, IDF1 and MOTA (percent), identity switches and fragmentations are TrackEval's, at
an overlap of a half where they need one; means over seeds. Totally hidden vehicles are not scored.
*Identity kept*: share of total occlusions after which a vehicle has the identity it had before.
*Count error*: crossings of a line through the middle of the image, against the true ones. *Held*:
percent of the 90 % intervals at 16 lines that hold the true count, where anything crossed, and
*width*, their mean width in vehicles. *ms* is processor time per frame: of `traffic` with its work
on pixels, of the baselines for boxes alone.
"-low" are baselines with thresholds lowered by hand for CenterNet's scores.
"""


def means(results: Sequence[TrafficResult]) -> list[TrafficResult]:
    """Average the seeds of every system in every case, in the order of the results."""
    groups: dict[tuple[str, str, str], list[TrafficResult]] = {}
    for one in results:
        groups.setdefault((one.scene, one.source, one.system), []).append(one)
    return [
        replace(
            runs[0],
            seed=None,
            values={
                name: statistics.fmean(run.values[name] for run in runs)
                for name in COLUMNS
                if name in runs[0].values
            },
            runs=len(runs),
        )
        for runs in groups.values()
    ]


def write_traffic_report(
    results: Sequence[TrafficResult], folder: Path, options: Mapping[str, Any]
) -> dict[str, tuple[list[str], Rows]]:
    """Write the three files, and return headings and rows by case.

    Parameters
    ----------
    results : sequence of TrafficResult
        Results of all systems.
    folder : Path
        Made where it is missing.
    options : mapping
        Plain values that say how the comparison was made; ``command`` is its command line.

    Raises
    ------
    InputError
        If a file cannot be written.
    """
    make_folder(folder)
    lines = means(results)
    cases: dict[str, list[TrafficResult]] = {}
    for line in lines:
        cases.setdefault(f"{line.scene}, {line.source}", []).append(line)
    shown = {title: _table(group) for title, group in cases.items()}
    parts = [f"## {title}\n\n{markdown(*table)}" for title, table in shown.items()]
    rows = [
        [
            line.scene,
            line.source,
            line.system,
            line.runs,
            *(line.values.get(name) for name in COLUMNS),
            line.occlusions,
            line.true,
        ]
        for line in lines
    ]
    header = ["scene", "detections", "system", "runs", *COLUMNS, "occlusions", "true"]
    write_text(folder / f"{NAME}.md", "\n".join(["# Many vehicles\n", RULES, *parts]))
    write_csv(folder / f"{NAME}.csv", header, rows)
    document = {
        "options": dict(options),
        "versions": versions(),
        "lines": [asdict(line) for line in lines],
        "results": [asdict(result) for result in results],
    }
    write_json(folder / f"{NAME}.json", document)
    return shown


def _table(lines: Sequence[TrafficResult]) -> tuple[list[str], Rows]:
    names = [name for name in COLUMNS if any(name in line.values for line in lines)]
    rows = [[line.system, *(_text(line, name) for name in names)] for line in lines]
    return ["system", *(COLUMNS[name][0] for name in names)], rows


def _text(line: TrafficResult, name: str) -> str:
    value = line.values.get(name)
    decimals = COLUMNS[name][1]
    if value is None:
        return NO_SCORE
    if name == "kept":
        return f"{value:.{decimals}f} % of {line.occlusions}"
    if name == "count_error":
        return f"{value:+.{decimals}f} % of {line.true}"
    is_count = name in {"IDSW", "Frag"} and value == int(value)
    return str(int(value)) if is_count else f"{value:.{decimals}f}"
