"""Score all variants, and OpenCV's trackers, on a folder of real sequences with truth.

    python benchmarks/sequences.py ../shared/sequences --peers .venv-peers/bin/python

`make peers` builds the environment of the peers; without ``--peers`` they are left out. Every cell
is the share of visible frames with an error below half the true box's diagonal, the mean over seeds
with the least and the most; defaults throughout.
"""

from __future__ import annotations

import argparse
import statistics
import tempfile
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

from vehicle_pf_tracker.evaluation.estimates import EstimateRow
from vehicle_pf_tracker.evaluation.metrics import measure
from vehicle_pf_tracker.evaluation.offline import OfflineTracker
from vehicle_pf_tracker.evaluation.peers.client import Peer
from vehicle_pf_tracker.evaluation.peers.rows import peer_rows
from vehicle_pf_tracker.evaluation.scores import score_frames
from vehicle_pf_tracker.recordings.importing import import_recording
from vehicle_pf_tracker.recordings.reader import Recording
from vehicle_pf_tracker.recordings.truth import Truth
from vehicle_pf_tracker.trackers.parameters import from_mapping
from vehicle_pf_tracker.trackers.registry import VARIANTS

PEERS = ("csrt", "kcf", "mil")
TITLE = f"""# The variants on real sequences

Share of visible frames with an error below half the true box's diagonal: mean over the seeds, and
the least and the most where they differ. Defaults throughout, the first true box, no help. Made by
`{(__doc__ or "").splitlines()[2].strip()}`.
`csrt`, `kcf` and `mil` are OpenCV's, scored by the same rules; where one gives a frame up, its last
box counts. The values of `apf`'s occlusion rule were chosen with these sequences in sight, so its
numbers here are no test on unseen video.
"""


def main() -> None:
    """Score and write the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--peers", type=Path)
    parser.add_argument("-o", "--output", type=Path)
    args = parser.parse_args()
    sequences = sorted(path.parent for path in args.folder.glob("*/*/sequence.json"))
    columns = [*VARIANTS, *(PEERS if args.peers else ())]
    score = partial(score_sequence, seeds=args.seeds, peers=args.peers)
    with ProcessPoolExecutor(2) as pool:
        rows = list(pool.map(score, sequences))
    lines = [TITLE, _line(["sequence", *columns]), _line(["---", *("---:" for _ in columns)])]
    for sequence, row in zip(sequences, rows, strict=True):
        lines.append(_line([sequence.name, *(_cell(row[name]) for name in columns)]))
    means = [statistics.fmean(statistics.fmean(row[name]) for row in rows) for name in columns]
    lines.append(_line(["**mean**", *(f"**{mean:.3f}**" for mean in means)]))
    text = "\n".join(lines) + "\n"
    print(text)
    if args.output:
        args.output.write_text(text, encoding="utf-8")


def score_sequence(folder: Path, seeds: int, peers: Path | None) -> dict[str, list[float]]:
    """Score everything on one sequence: the shares of each seed by name."""
    with tempfile.TemporaryDirectory() as scratch:
        import_recording(folder, Path(scratch, "recording"))
        recording = Recording(Path(scratch, "recording"))
        frames = [(image.stamp_ns, image.frame) for image in recording.frames()]
        truth = recording.truth()
    shares: dict[str, list[float]] = {}
    for name, variant in VARIANTS.items():
        for seed in range(seeds):
            parameters = from_mapping(variant.parameters, {"seed": seed})
            tracker = OfflineTracker(variant, parameters, first_truth=truth[0])
            shares.setdefault(name, []).append(_share(list(tracker.rows(frames)), truth))
    for name in PEERS if peers else ():
        with Peer(name, peers) as peer:
            shares[name] = [_share(list(peer_rows(peer, frames, truth[0])), truth)]
    return shares


def _share(rows: Sequence[EstimateRow], truth: Sequence[Truth]) -> float:
    return measure(score_frames(rows, truth)).on_target or 0.0


def _cell(shares: Sequence[float]) -> str:
    mean, low, high = statistics.fmean(shares), min(shares), max(shares)
    return f"{mean:.3f}" if high - low < 5e-4 else f"{mean:.3f} ({low:.2f}-{high:.2f})"


def _line(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"


if __name__ == "__main__":
    main()
