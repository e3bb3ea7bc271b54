# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Baselines: OpenCV's trackers, each in a process of its own."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from vehicle_pf_tracker.core.association import PAIRED_WITHIN_S, max_diff_ns
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError, suggestion
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.evaluation.baseline_process import Worker
from vehicle_pf_tracker.results.estimates import REJECTED_MODE, WAITING_MODE, EstimateRow

BASELINE_MODELS: Mapping[str, tuple[str, ...]] = {
    "csrt": (),
    "kcf": (),
    "mil": (),
    "vit": ("net",),
    "nano": ("backbone", "neckhead"),
    "dasiamrpn": ("model", "kernel_cls1", "kernel_r1"),
}
"""Model files that the user brings, by the name of the baseline."""


class BaselineAnswer(NamedTuple):
    """A baseline's answer to one frame.

    Attributes
    ----------
    box : Box
        Estimated box, px; the last known one where the baseline gave the frame up.
    found : bool
        True if the baseline claims to see its target.
    seconds : float
        Processor time of the tracking thread, s, without the transfer of the frame.
    """

    box: Box
    found: bool
    seconds: float


class Baseline(Worker):
    """One of OpenCV's trackers.

    A new process repeats a run exactly. Started anew in the same process, MIL draws other samples.

    Parameters
    ----------
    name : str
        A key of `BASELINE_MODELS`.
    python : Path or None
        Interpreter with OpenCV's contrib package; None looks where `baseline_python` says.
    models : mapping of str to Path
        Model files by the names that `BASELINE_MODELS` gives for this baseline.

    Raises
    ------
    InputError
        If there is no such baseline, interpreter, tracker or model file.
    """

    def __init__(
        self,
        name: str,
        python: Path | None = None,
        models: Mapping[str, Path] = MappingProxyType({}),
    ) -> None:
        words = [f"{key}={path}" for key, path in _checked_models(name, models).items()]
        self.name = name
        super().__init__(f"the baseline {name}", python, [name, *words])

    def start(self, frame: Frame, box: Box) -> BaselineAnswer:
        """Start anew on `box` (rounded to whole px, as these trackers require) of `frame`.

        Raises
        ------
        InputError
            If the baseline refuses the box, or has died.
        """
        # Whole px, at least one, or OpenCV would refuse the box.
        width = max(round(box.width), 1)
        height = max(round(box.height), 1)
        # Until it answers: a tracker that gives up at once stands on the box it was given.
        self._box = box
        return self._track(frame, box=[round(box.x), round(box.y), width, height])

    def step(self, frame: Frame) -> BaselineAnswer:
        """Follow the target it was started on into the next frame, which is (H, W, 3) RGB.

        Raises
        ------
        InputError
            If the baseline has died.
        """
        return self._track(frame)

    def _track(self, frame: Frame, **request: object) -> BaselineAnswer:
        width, height = frame_size(frame)
        pixels = np.ascontiguousarray(frame)
        answer = self._ask({"height": height, "width": width, **request}, pixels)
        found = answer["box"] is not None
        # Where it has given up its last box stands, as for every system.
        if found:
            self._box = Box(*answer["box"])
        return BaselineAnswer(self._box, found, float(answer["seconds"]))


def unknown_baseline(name: str) -> InputError:
    """Make the error about a baseline that there is not."""
    did_you_mean = suggestion(name, BASELINE_MODELS)
    return InputError(
        f"unknown baseline {name!r}{did_you_mean}; the baselines are {', '.join(BASELINE_MODELS)}"
    )


def _checked_models(name: str, models: Mapping[str, Path]) -> dict[str, Path]:
    if name not in BASELINE_MODELS:
        raise unknown_baseline(name)
    required = BASELINE_MODELS[name]
    if set(models) != set(required):
        words = f"these model files: {', '.join(required)}" if required else "no model files"
        given = f"got {', '.join(sorted(models))}" if models else "got none"
        raise InputError(f"the baseline {name} needs {words}; {given}")
    for key, path in models.items():
        if not Path(path).is_file():
            raise InputError(f"there is no file {path} for the model {key} of the baseline {name}")
    return {key: Path(path).absolute() for key, path in models.items()}


def baseline_rows(
    baseline: Baseline,
    frames: Iterable[tuple[int, Frame | None]],
    first_truth: Truth,
    first: int = 1,
) -> Iterator[EstimateRow]:
    """Track through (stamp in ns, frame) pairs, numbered from `first`; give a row for each.

    The baseline starts on the first truth's box, in the first image that belongs to it by its
    stamp. Where it gives a frame up, the row is ``LOST`` at its last box. ``step_ms`` is the
    processor time of one thread.

    Raises
    ------
    InputError
        If no image belongs to the first truth, or the baseline cannot go on.
    """
    limit = max_diff_ns(PAIRED_WITHIN_S)
    started = False
    for number, (stamp, frame) in enumerate(frames, start=first):
        # An image that cannot be read goes to no tracker, as in a node.
        if frame is None:
            yield EstimateRow.without(number, stamp, REJECTED_MODE)
        elif started:
            yield baseline_row(baseline.step(frame), number, stamp)
        elif abs(stamp - first_truth.stamp_ns) <= limit:
            started = True
            yield baseline_row(baseline.start(frame, first_truth.box), number, stamp)
        else:
            yield EstimateRow.without(number, stamp, WAITING_MODE)
    # Only now is it known that the first truth lies between the images, or beyond them.
    if not started:
        raise InputError(
            f"no image is within {PAIRED_WITHIN_S:g} s of the first truth, "
            f"at {first_truth.stamp_ns / 1e9:.3f} s; the baseline {baseline.name} cannot start"
        )


def baseline_row(answer: BaselineAnswer, number: int, stamp_ns: int) -> EstimateRow:
    """Return a baseline's answer as the row of an image."""
    box = answer.box
    mode = "TRACKING" if answer.found else "LOST"
    step_ms = answer.seconds * 1e3
    return EstimateRow(
        number, stamp_ns, *box.centre, box.width, box.height, mode, None, None, step_ms
    )
