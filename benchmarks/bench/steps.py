"""The full step of every variant against OpenCV's trackers, on one vehicle of 40x30 px in VGA."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from pathlib import Path

from benchmarks.bench.case import Case
from benchmarks.bench.effort import Effort
from benchmarks.bench.turns import Follower, Own, Theirs, follow
from vehicle_pf_tracker.evaluation.baselines.client import Peer
from vehicle_pf_tracker.trackers.registry import VARIANTS

PEERS = ("csrt", "kcf", "mil")


def measure(
    wanted: Callable[[str], bool], effort: Effort, python: Path | None
) -> tuple[list[Case], dict[str, float]]:
    """Measure the cases ``step/VARIANT/PEER``, and how long each stayed on the vehicle.

    Raises
    ------
    InputError
        If the interpreter of the peers, or a peer, is not there.
    """
    pairs = [(own, peer) for own in VARIANTS for peer in PEERS if wanted(f"step/{own}/{peer}")]
    if not pairs:
        return [], {}
    with contextlib.ExitStack() as stack:
        followers: dict[str, Follower] = {own: Own(own) for own, _ in pairs}
        for _, peer in pairs:
            if peer not in followers:
                followers[peer] = Theirs(stack.enter_context(Peer(peer, python)))
        times, on_target = follow(followers, range(effort.passes), effort.frames)
    cases = [Case.of(f"step/{own}/{peer}", times[own], times[peer]) for own, peer in pairs]
    return cases, on_target
