"""What each part of `fusion` buys: every part switched off in turn, on what it was not tuned on.

    python benchmarks/fusion_ablation.py ../shared/sequences

Every row runs `fusion` with one switch turned, on three real sequences that took no part in its
making and on synthetic scenes of seeds that did not either.
"""

from __future__ import annotations

import argparse
import statistics
import tempfile
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import cache, partial
from pathlib import Path
from typing import TypeAlias

from vehicle_pf_tracker.evaluation.metrics import measure
from vehicle_pf_tracker.evaluation.offline import OfflineTracker
from vehicle_pf_tracker.evaluation.scores import score_frames
from vehicle_pf_tracker.features.frame import Frame
from vehicle_pf_tracker.recordings.importing import import_recording
from vehicle_pf_tracker.recordings.reader import Recording
from vehicle_pf_tracker.recordings.truth import Truth
from vehicle_pf_tracker.scenes.catalogue import make_scene
from vehicle_pf_tracker.trackers.parameters import from_mapping
from vehicle_pf_tracker.trackers.registry import find_variant

Footage: TypeAlias = tuple[list[tuple[int, Frame | None]], Sequence[Truth]]

HELD_OUT = (
    "cdnet_highway/car_e",
    "m6_dual_carriageway/red_car",
    "semi_synthetic/cdnet_pole_partial",
)
SCENES = ("bridge", "bus")
OFF: dict[str, dict[str, object]] = {
    "all parts": {},
    "no anchor template": {"cues.anchor": False},
    "no following template": {"cues.following": False},
    "no templates": {"cues.anchor": False, "cues.following": False},
    "no colour": {"cues.colour": False},
    "no parts": {"cues.parts": False},
    "fixed weights of cues": {"cues.adaptive": False},
    "no scale": {"motion.scale": False},
    "no camera motion": {"motion.camera": False},
    "no retrospect": {"hiding.retrospect": False},
    "no perspective": {"hiding.projective": False},
    "no drift": {"hiding.drift": False},
    "no gate on the path": {"hiding.gate": False},
    "no search": {"hiding.search": False},
    "no resampling in a frame": {"resampling_passes": 0},
}


def main() -> None:
    """Run all rows and print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--scenes", nargs="*", default=SCENES)
    args = parser.parse_args()
    run = partial(table_row, folder=args.folder, seeds=args.seeds, scenes=tuple(args.scenes))
    print("| part | on target, held out | RMSE held out, px | on target, scenes | recovered |")
    print("|---|---:|---:|---:|---:|")
    with ProcessPoolExecutor(2) as pool:
        for line in pool.map(run, OFF):
            print(line, flush=True)


def table_row(part: str, folder: Path, seeds: int, scenes: tuple[str, ...]) -> str:
    """Measure with `part` off and return a line of the table."""
    real = [_measured(part, sequence(folder / name), s) for name in HELD_OUT for s in range(seeds)]
    made = [_measured(part, scene(name, s), s) for name in scenes for s in range(seeds)]
    judged = [one for _, _, recovered in made for one in recovered if one is not None]
    cells = [
        part,
        f"{statistics.fmean(share for share, _, _ in real):.3f}",
        f"{statistics.fmean(rmse for _, rmse, _ in real):.1f}",
        f"{statistics.fmean(share for share, _, _ in made):.3f}",
        f"{sum(judged)} of {len(judged)}",
    ]
    return f"| {' | '.join(cells)} |"


def _measured(
    part: str, footage: Footage, seed: int
) -> tuple[float, float, tuple[bool | None, ...]]:
    """Share of visible frames on the target, visible RMSE in px, and each recovery."""
    frames, truth = footage
    variant = find_variant("fusion")
    parameters = from_mapping(variant.parameters, {**OFF[part], "seed": seed})
    rows = list(OfflineTracker(variant, parameters, first_truth=truth[0]).rows(frames))
    metrics = measure(score_frames(rows, truth))
    return metrics.on_target or 0.0, metrics.rmse_visible_px or 0.0, metrics.recovered


@cache
def sequence(folder: Path) -> Footage:
    """Import a real sequence."""
    with tempfile.TemporaryDirectory() as scratch:
        import_recording(folder, Path(scratch, "recording"))
        recording = Recording(Path(scratch, "recording"))
        return [(image.stamp_ns, image.frame) for image in recording.frames()], recording.truth()


@cache
def scene(name: str, seed: int) -> Footage:
    """Make a synthetic scene."""
    made = list(make_scene(name, seed=seed).frames())
    return [(one.truth.stamp_ns, one.frame) for one in made], [one.truth for one in made]


if __name__ == "__main__":
    main()
