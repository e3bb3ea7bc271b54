# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The choice of cases from a set of sequences."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

from laboratory.stress.cases import Case
from laboratory.stress.footage import StressSource
from laboratory.stress.kinds import STRESS_KINDS, Kind, case_seed
from laboratory.stress.placing import LEAST_LEAD
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Occlusion
from vehicle_pf_tracker.scenes.random_streams import stream

QUICK_PER_SEQUENCE = 8
"""Cases of a sequence in the quick battery: one of each turn of `_TURNS`."""
QUICK_FRAMES = 150
"""Frames of a case in it: nineteen sequences make 152 cases of five seconds, minutes, no hour."""
_TURNS = ("occluder", "start", "view", "occluder", "image", "occluder", "start", "camera")
"""Groups that a small battery takes cases from in turns: what trackers fail at comes thrice."""


def full_battery(sources: Iterable[StressSource], seed: int = 0) -> list[Case]:
    """List every case of some sequences, about 55 for each."""
    return list_cases(sources, seed=seed)


def quick_battery(sources: Iterable[StressSource], seed: int = 0) -> list[Case]:
    """List eight cases for each sequence, of every group, of at most 150 frames each."""
    return list_cases(sources, per_sequence=QUICK_PER_SEQUENCE, max_frames=QUICK_FRAMES, seed=seed)


def list_cases(
    sources: Iterable[StressSource],
    *,
    kinds: Sequence[str] | None = None,
    per_sequence: int | None = None,
    limit: int | None = None,
    max_frames: int | None = None,
    seed: int = 0,
) -> list[Case]:
    """List cases, sequence by sequence.

    Parameters
    ----------
    sources : iterable of StressSource
        The sequences.
    kinds : sequence of str or None
        Names of `STRESS_KINDS`; None takes all.
    per_sequence : int or None
        Cases of each sequence at most, drawn at random from all groups of kinds in turns.
    limit : int or None
        Cases at most, evenly spread over the list.
    max_frames : int or None
        Frames of a case at most: the first ones, but for painted occluders those around it.
    seed : int
        Seed of everything random.

    Raises
    ------
    InputError
        If a kind is unknown or a sequence cannot be read.
    """
    chosen = [_kind(name) for name in (kinds or STRESS_KINDS)]
    cases: list[Case] = []
    # Cut before cases are chosen: those that a cut would spoil must not take a place of the few.
    for source in sources:
        own = [(kind, case) for kind in chosen for case in kind.cases(source, seed)]
        short = [(kind, cut) for kind, case in own if (cut := _cut(case, kind, max_frames))]
        if per_sequence is None:
            cases += [case for _, case in short]
        else:
            cases += itertools.islice(_in_turns(short, case_seed(seed, source.name)), per_sequence)
    return cases if limit is None else _spread(cases, limit)


def _kind(name: str) -> Kind:
    if name not in STRESS_KINDS:
        raise InputError(f"there is no kind {name!r}; the kinds are {', '.join(STRESS_KINDS)}")
    return STRESS_KINDS[name]


def _cut(case: Case, kind: Kind, max_frames: int | None) -> Case | None:
    """Shorten a case; None where an occlusion would lose what it is judged by."""
    beyond = 0 if max_frames is None else case.count - max_frames
    if beyond <= 0:
        return case
    # Kinds without an occluder are as hard at their beginning as later.
    if kind.group != "occluder":
        return replace(case, count=case.count - beyond)
    occluded = [
        truth is not None and truth.occlusion is not Occlusion.NONE for truth in case.truths()
    ]
    # Cut at the beginning: the frames after an occlusion are what it is judged by.
    if occluded.index(True) - beyond < LEAST_LEAD:
        return None
    return replace(case, first=case.first + beyond, count=case.count - beyond)


def _in_turns(cases: Sequence[tuple[Kind, Case]], seed: int) -> Iterator[Case]:
    """Give all cases, those of different groups and kinds in turns, at random within a kind."""
    rng = stream(seed, "turns")
    # Shuffled as a whole, then parted: the order within each kind is random, too.
    shuffled = [cases[i] for i in rng.permutation(len(cases))]
    by_group = {
        group: _alternating([(kind.name, case) for kind, case in shuffled if kind.group == group])
        for group in dict.fromkeys(_TURNS)
    }
    left = len(cases)
    # A group that has no more cases is passed over, until none has.
    for group in itertools.cycle(_TURNS):
        if not left:
            return
        case = next(by_group[group], None)
        if case is not None:
            left -= 1
            yield case


def _alternating(cases: Sequence[tuple[str, Case]]) -> Iterator[Case]:
    names = dict.fromkeys(name for name, _ in cases)
    columns = [[case for name, case in cases if name == wanted] for wanted in names]
    for row in itertools.zip_longest(*columns):
        yield from (case for case in row if case is not None)


def _spread(cases: Sequence[Case], limit: int) -> list[Case]:
    if limit >= len(cases):
        return list(cases)
    return [cases[i * len(cases) // limit] for i in range(limit)]
