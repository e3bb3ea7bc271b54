# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Identities kept through total occlusions."""

from __future__ import annotations

from collections import Counter as Tally
from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.evaluation.traffic.box_matches import matches
from vehicle_pf_tracker.evaluation.traffic.sequence import TrafficSequence

_WINDOW = 30
"""Frames before and after an occlusion in which the identity is looked for: a second at 30 Hz."""
_GLIMPSE = 5
"""Frames in sight below which two occlusions are one, a choice: a gap between two posts."""
_KNOWN_AFTER = 10
"""Frames in sight before an occlusion from which a tracker can know the vehicle, a choice: a
third of a second at 30 Hz."""


def kept_identities(sequence: TrafficSequence, tracks: Array) -> tuple[int, int]:
    """Count total occlusions after which a vehicle has the identity that it had before.

    Before is the identity of the last box on the vehicle within `_WINDOW` frames, after is the one
    that most boxes on it have within as many. A vehicle that is not followed before or after has
    not kept its identity.

    Returns
    -------
    kept, judged : int
        Occlusions of vehicles that were in sight for `_KNOWN_AFTER` frames before.
    """
    # Matched once per frame: an occlusion is then judged by looking up.
    followed = _followed(sequence, tracks)
    kept = judged = 0
    for vehicle in np.unique(sequence.truth[:, 1]).tolist():
        rows = sequence.truth[:, 1] == vehicle
        seen = sequence.truth[rows & ~sequence.hidden, 0].astype(int).tolist()
        hidden = set(sequence.truth[rows & sequence.hidden, 0].astype(int).tolist())
        spells = list(_spells(seen, hidden))
        for before, after in pairwise(spells):
            # A tracker that never had time to know the vehicle has nothing to keep.
            if len(before) >= _KNOWN_AFTER:
                judged += 1
                first, then = (
                    [followed[at, vehicle] for at in frames if (at, vehicle) in followed]
                    for frames in (before[-_WINDOW:], after[:_WINDOW])
                )
                # The last before, as that is what was hidden; the most frequent after, as one
                # wrong box there is no lost identity.
                kept += bool(first and then) and Tally(then).most_common(1)[0][0] == first[-1]
    return kept, judged


def _spells(seen: list[int], hidden: set[int]) -> Iterator[list[int]]:
    """Divide frames in sight at total occlusions; glimpses between two are left out."""
    spell: list[int] = []
    # Only hidden frames between two sightings divide them: one without truth does not.
    for frame, before in zip(seen, [None, *seen], strict=False):
        if before is not None and any(number in hidden for number in range(before + 1, frame)):
            # Too short to be followed: the occlusions before and after it are one.
            if len(spell) >= _GLIMPSE:
                yield spell
            spell = []
        spell.append(frame)
    if len(spell) >= _GLIMPSE:
        yield spell


def _followed(sequence: TrafficSequence, tracks: Array) -> dict[tuple[int, int], int]:
    """Identity of the track on each vehicle in sight, by frame and vehicle."""
    found: dict[tuple[int, int], int] = {}
    for frame in range(1, sequence.frame_count + 1):
        truth = sequence.truth[(sequence.truth[:, 0] == frame) & ~sequence.hidden]
        boxes = tracks[tracks[:, 0] == frame]
        for row, column in zip(*matches(truth[:, 2:], boxes[:, 2:6]), strict=True):
            found[frame, int(truth[row, 1])] = int(boxes[column, 1])
    return found
