"""Runs of `fusion`, and what the tables of docs/fusion.md tell of each."""

from __future__ import annotations

import tempfile
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

import cv2

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.evaluation.metrics import measure
from vehicle_pf_tracker.evaluation.offline import OfflineTracker
from vehicle_pf_tracker.evaluation.scores import FrameScore, Scores, score_frames
from vehicle_pf_tracker.parameters.table import from_mapping
from vehicle_pf_tracker.recordings.importing import import_recording
from vehicle_pf_tracker.recordings.reader import Recording
from vehicle_pf_tracker.scenes.catalogue import make_scene
from vehicle_pf_tracker.trackers.estimate import Mode
from vehicle_pf_tracker.trackers.registry import find_variant

Footage: TypeAlias = tuple[list[tuple[int, Frame | None]], Sequence[Truth]]

HELD_OUT = ("car_e", "red_car", "cdnet_pole_partial")
TUNED_ON = ("white_van", "Suv", "cdnet_bridge_total", "silver_estate", "car_a", "Car4")
CLOSE_PX = 15.0


@dataclass(frozen=True, slots=True)
class Run:
    """One run; None where there is nothing to tell it from.

    Attributes
    ----------
    on_target : float or None
        Share of visible frames with an error below half the true box's diagonal.
    close : float or None
        Share of visible frames with an error below 15 px.
    rmse_px : float or None
        Over visible frames.
    recovered : tuple of bool
        For each total occlusion that can be judged.
    hidden : float or None
        Share of totally hidden frames in which the mode is not TRACKING.
    clear : float or None
        The same of fully visible frames.
    false_run : int
        Most frames on end that say TRACKING with an error above the true box's diagonal.
    """

    on_target: float | None
    close: float | None
    rmse_px: float | None
    recovered: tuple[bool, ...]
    hidden: float | None
    clear: float | None
    false_run: int

    @property
    def all_recovered(self) -> bool | None:
        """Whether every occlusion that can be judged was recovered from; None without any."""
        return all(self.recovered) if self.recovered else None


def run(footage: Footage, seed: int, settings: Mapping[str, object] | None = None) -> Run:
    """Follow through `footage` from the first true box on, with `settings` over the defaults."""
    cv2.setNumThreads(1)
    frames, truth = footage
    variant = find_variant("fusion")
    parameters = from_mapping(variant.parameters, {**(settings or {}), "seed": seed})
    tracker = OfflineTracker(variant, parameters, first_truth=truth[0])
    return summary(score_frames(list(tracker.rows(frames)), truth))


def summary(scores: Scores) -> Run:
    """Tell what the tables need of the scores of one run."""
    metrics = measure(scores)
    visible = [frame for frame in scores.counted if not frame.hidden]
    return Run(
        on_target=metrics.on_target,
        close=_share(one.error is not None and one.error < CLOSE_PX for one in visible),
        rmse_px=metrics.rmse_visible_px,
        recovered=tuple(one for one in metrics.recovered if one is not None),
        hidden=metrics.hidden_not_tracking,
        clear=_share(not _is_tracking(one) for one in visible if _is_fully_visible(one)),
        false_run=longest_run(_is_false_claim(one) for one in scores.counted),
    )


def longest_run(hits: Iterable[bool]) -> int:
    """Most hits on end."""
    longest = now = 0
    for hit in hits:
        now = now + 1 if hit else 0
        longest = max(longest, now)
    return longest


def sequence(folder: Path) -> Footage:
    """Read a recording, or import a real sequence from its own folder.

    Raises
    ------
    InputError
        If there is neither, or it has no truth.
    """
    if (folder / "metadata.yaml").exists():
        return _footage(Recording(folder))
    with tempfile.TemporaryDirectory() as scratch:
        import_recording(folder, Path(scratch, "recording"))
        return _footage(Recording(Path(scratch, "recording")))


def find_sequence(folder: Path, name: str) -> Path:
    """Find the sequence `name` in a folder of recordings, or of collections of sequences.

    Raises
    ------
    InputError
        If it is not there.
    """
    found = [folder / name, *sorted(folder.glob(f"*/{name}"))]
    for one in found:
        if one.is_dir():
            return one
    raise InputError(f"{folder} has no sequence {name}; import it, or name its parent folder")


def scene(name: str, seed: int) -> Footage:
    """Make a synthetic scene."""
    made = list(make_scene(name, seed=seed).frames())
    return [(one.truth.stamp_ns, one.frame) for one in made], [one.truth for one in made]


def _footage(recording: Recording) -> Footage:
    truth = recording.truth()
    if not truth:
        raise InputError(f"{recording.path} has no truth to start on; import it with its truth")
    return [(image.stamp_ns, image.frame) for image in recording.frames()], truth


def _is_tracking(frame: FrameScore) -> bool:
    return frame.row.mode == Mode.TRACKING.value


def _is_fully_visible(frame: FrameScore) -> bool:
    return frame.truth is not None and frame.truth.occlusion is Occlusion.NONE


def _is_false_claim(frame: FrameScore) -> bool:
    if frame.truth is None or frame.error is None:
        return False
    return _is_tracking(frame) and frame.error > frame.truth.box.diagonal


def _share(hits: Iterable[bool]) -> float | None:
    counted = list(hits)
    return sum(counted) / len(counted) if counted else None
