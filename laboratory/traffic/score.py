# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Score files of tracks against folders with truth, beside baselines on the same detections.

    python -m laboratory.traffic.score FOLDER TRACKS.txt
    python -m laboratory.traffic.score FOLDER... --baselines

Files are in MOTChallenge's layout; a row of scores for each is printed. The interpreter of the
baselines is found as `evaluate --baselines` finds it.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from vehicle_pf_tracker.evaluation.traffic.baselines import TRAFFIC_BASELINES, TrafficWorker
from vehicle_pf_tracker.evaluation.traffic.sequence import read_sequence, read_table

COLUMNS = ("HOTA", "DetA", "AssA", "IDF1", "MOTA", "IDSW", "Frag", "FP", "FN")


def main() -> None:
    """Print one row for each file or baseline."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("paths", nargs="+", type=Path, help="folders, then files of tracks")
    parser.add_argument("--baselines", action="store_true", help="run the baselines on det/*.txt")
    args = parser.parse_args()
    folders = [path for path in args.paths if path.is_dir()]
    with TrafficWorker() as worker:
        print("| scene | tracks |", " | ".join(COLUMNS), "|")
        print("|---|---|" + "---:|" * len(COLUMNS))
        for folder in folders:
            sequence = read_sequence(folder)
            # Each file against each folder: the names of files say nothing about scenes.
            for path in args.paths:
                if path.is_file():
                    row(sequence.name, str(path), worker.score(sequence, read_table(path, 6)))
            for detector, boxes in sequence.detections.items() if args.baselines else ():
                for name in TRAFFIC_BASELINES:
                    tracks, _ = worker.track(name, sequence, boxes)
                    row(sequence.name, f"{detector}, {name}", worker.score(sequence, tracks))


def row(scene: str, label: str, scores: dict[str, float]) -> None:
    """Print one row."""
    cells = [
        f"{scores[name]:.1f}" if isinstance(scores[name], float) else str(scores[name])
        for name in COLUMNS
    ]
    print(f"| {scene} | {label} |", " | ".join(cells), "|", flush=True)


if __name__ == "__main__":
    main()
