"""A peer's answers as rows of `estimates.csv`, so that the same scorer judges it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.evaluation.association import MAX_DIFF, max_diff_ns
from vehicle_pf_tracker.evaluation.baselines.client import Peer, PeerAnswer
from vehicle_pf_tracker.evaluation.estimates import REJECTED, WAITING, EstimateRow


def peer_rows(
    peer: Peer, frames: Iterable[tuple[int, Frame | None]], first_truth: Truth
) -> Iterator[EstimateRow]:
    """Track through (stamp in ns, frame) pairs, and give one row for each.

    The peer starts on the first truth's box, in the first image that belongs to it by its stamp.
    Where it gives up, the row is ``LOST`` at its last box. ``step_ms`` is CPU time, which a peer
    that works in one thread alone needs at least.

    Raises
    ------
    InputError
        If no image belongs to the first truth, or the peer cannot go on.
    """
    limit = max_diff_ns(MAX_DIFF)
    started = False
    for number, (stamp, frame) in enumerate(frames, start=1):
        if frame is None:
            yield EstimateRow.without(number, stamp, REJECTED)
        elif started:
            yield _row(number, stamp, peer.step(frame))
        elif abs(stamp - first_truth.stamp_ns) <= limit:
            started = True
            yield _row(number, stamp, peer.start(frame, first_truth.box))
        else:
            yield EstimateRow.without(number, stamp, WAITING)
    if not started:
        raise InputError(
            f"no image is within {MAX_DIFF:g} s of the first truth, "
            f"at {first_truth.stamp_ns / 1e9:.3f} s; the peer {peer.name} cannot start"
        )


def _row(number: int, stamp_ns: int, answer: PeerAnswer) -> EstimateRow:
    box = answer.box
    return EstimateRow(
        frame=number,
        stamp_ns=stamp_ns,
        x=box.centre[0],
        y=box.centre[1],
        width=box.width,
        height=box.height,
        mode="TRACKING" if answer.found else "LOST",
        confidence=None,
        n_eff=None,
        step_ms=answer.seconds * 1e3,
    )
