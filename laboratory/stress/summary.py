# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Means of the scores of a battery, by kind, by camera and by what an occlusion was like."""

from __future__ import annotations

import itertools
import statistics
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

from laboratory.stress.calibration import Reliability
from laboratory.stress.running import Result
from laboratory.stress.scoring import Score
from vehicle_pf_tracker.evaluation.statistics import Summary, summarise

ALL_CASES = "(all)"


@dataclass(frozen=True, slots=True)
class Measure:
    """A measure of a run.

    Attributes
    ----------
    title : str
        Heading of the column in tables.
    unit : str
        ``px``, ``frames`` or empty for a share.
    of : callable
        Takes it from a score; None where there is nothing to take it from.
    """

    title: str
    unit: str
    of: Callable[[Score], float | None]


CASE_MEASURES: Mapping[str, Measure] = MappingProxyType(
    {
        "on_target": Measure("on target", "", lambda s: s.on_target),
        "mean_iou": Measure("IoU", "", lambda s: s.mean_iou),
        "rmse_visible_px": Measure("RMSE, px", "px", lambda s: s.rmse_visible_px),
        "lost": Measure("lost", "", lambda s: None if s.lost is None else float(s.lost)),
        "recovered": Measure(
            "recovered", "", lambda s: s.recovered / s.judged if s.judged else None
        ),
        "doubted": Measure("doubted", "", lambda s: s.doubted),
        "doubted_in_full_view": Measure("in full view", "", lambda s: s.doubted_in_full_view),
        "claimed_hidden": Measure("claimed hidden", "", lambda s: s.claimed_hidden),
        "longest_false_tracking": Measure(
            "false TRACKING", "frames", lambda s: float(s.longest_false_tracking)
        ),
    }
)


@dataclass(frozen=True, slots=True)
class Group:
    """Results of one system that are summed up together.

    Attributes
    ----------
    system : str
        Label of the system.
    by : str
        Property that they share: ``kind``, ``path``, ``course``, ``occlusion``, ``camera`` or
        `ALL_CASES`.
    name : str
        Value of that property.
    results : tuple of Result
        Runs of all seeds.
    """

    system: str
    by: str
    name: str
    results: tuple[Result, ...]

    @property
    def scores(self) -> list[Score]:
        """Scores of the runs."""
        return [result.score for result in self.results]

    @property
    def cases(self) -> int:
        """Number of different cases."""
        return len({result.case.name for result in self.results})

    @property
    def recoveries(self) -> tuple[int, int]:
        """Total occlusions recovered from, and judged."""
        return sum(s.recovered for s in self.scores), sum(s.judged for s in self.scores)

    def reliability(self, *, hidden: bool = False) -> Reliability:
        """Pool the confidences of all visible, or of all hidden frames."""
        return Reliability.pooled(
            s.reliability_hidden if hidden else s.reliability_visible for s in self.scores
        )

    def summary(self, measure: str) -> Summary | None:
        """Return the mean of a measure with its bootstrap interval; None without a value.

        The cases of a camera share its difficulties. Where there are several cameras, each one's
        mean is a sample; within one camera each case's mean over the seeds is.
        """
        take = CASE_MEASURES[measure].of
        # Seeds of a case first: they are repetitions of one difficulty.
        by_case = _means((result.case.name, take(result.score)) for result in self.results)
        if self.by == "camera":
            return summarise(list(by_case.values()))
        camera = {result.case.name: result.case.camera for result in self.results}
        by_camera = _means((camera[case], value) for case, value in by_case.items())
        return summarise(list(by_camera.values()))


def groups(results: Sequence[Result]) -> list[Group]:
    """Group results by system, and these by all, kind, occlusion and camera."""
    grouped = []
    for system in dict.fromkeys(result.system for result in results):
        own = [result for result in results if result.system == system]
        grouped.append(Group(system, ALL_CASES, ALL_CASES, tuple(own)))
        for by, name in _GROUPINGS.items():
            # An empty name: the case is in no group of this property.
            for value in dict.fromkeys(filter(None, map(name, own))):
                members = tuple(result for result in own if name(result) == value)
                grouped.append(Group(system, by, value, members))
    return grouped


def difference(results: Sequence[Result], one: str, other: str, measure: str) -> Summary | None:
    """Compare two systems case by case: the mean of `one` minus `other`, with its interval.

    Differences of the cases and seeds that both have are averaged over each camera; the interval is
    over the cameras. None where no case has both.
    """
    take = CASE_MEASURES[measure].of
    scores = {(r.system, r.case.name, r.seed): take(r.score) for r in results}
    seeds = sorted({result.seed for result in results})
    camera = {result.case.name: result.case.camera for result in results}
    pairs = []
    # Paired: what makes a case hard is in both, and cancels out.
    for case, seed in itertools.product(camera, seeds):
        first = scores.get((one, case, seed))
        second = scores.get((other, case, seed))
        if first is not None and second is not None:
            pairs.append((case, first - second))
    # Over cameras, as in `Group.summary`: cases of one camera share its difficulties.
    by_camera = _means((camera[case], mean) for case, mean in _means(pairs).items())
    return summarise(list(by_camera.values()))


def _occlusion(result: Result) -> str:
    """Describe a painted total occlusion; empty for other cases."""
    case = result.case
    # A post hides nothing wholly: it is no total occlusion.
    if not case.label("path") or case.label("hidden") == "0":
        return ""
    return " ".join(part for part in (case.label("speed"), case.kind, case.label("path")) if part)


_GROUPINGS: dict[str, Callable[[Result], str]] = {
    "kind": lambda result: result.case.kind,
    "path": lambda result: result.case.label("path") if _occlusion(result) else "",
    "course": lambda result: result.case.label("course") if _occlusion(result) else "",
    "occlusion": _occlusion,
    "camera": lambda result: result.case.camera,
}


def _means(pairs: Iterable[tuple[str, float | None]]) -> dict[str, float]:
    values: dict[str, list[float]] = {}
    for name, value in pairs:
        if value is not None:
            values.setdefault(name, []).append(value)
    return {name: statistics.fmean(each) for name, each in values.items()}


def faults(results: Iterable[Result]) -> Iterator[str]:
    """Tell of the runs that did not come to their end."""
    for result in results:
        if result.score.fault:
            yield f"{result.system} in {result.case.name}, seed {result.seed}: {result.score.fault}"
