# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Sources of detections: the detector that the parameters ask for, and files of MOTChallenge."""

from __future__ import annotations

import importlib
import math
import os
import time
from array import array
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.errors import InputError, read_text
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.detection.detector import Detector, FollowedVehicle
from vehicle_pf_tracker.detection.motion_detector import MotionDetector
from vehicle_pf_tracker.detection.network import Network, Tensor
from vehicle_pf_tracker.detection.network_detector import NetworkDetector
from vehicle_pf_tracker.detection.parameters import MODEL, MOTION, DetectorParameters
from vehicle_pf_tracker.following.fetching import Progress, silent
from vehicle_pf_tracker.following.model_files import discard, model_file
from vehicle_pf_tracker.recordings.box_sizes import misfit
from vehicle_pf_tracker.recordings.text_tables import numbers_in, table_rows

_SHARE = 0.8
"""Share of the images' period that detecting and following may take; decoding and drawing need the
rest."""
_LONGEST = 0.1
"""Longest time between two looks of a detector, s, also where the rate cannot be kept. On a dual
carriageway at 30 Hz every third image leaves 97 % of IDF1, every sixth 56 %."""
_RECENT = 0.1
"""Weight of the latest image among the costs: a mean over ten follows a load of the machine within
a second, and one slow image changes nothing."""


class OpenedNetwork:
    """A network by ONNX Runtime, loaded from its file or URL.

    A copy, also one in another process, loads it again: the runtime's sessions cannot be copied.

    Parameters
    ----------
    model : str
        The file or URL.
    progress : Progress
        Shows how it is fetched.

    Raises
    ------
    InputError
        If ONNX Runtime is not installed, or the file cannot be used.
    """

    def __init__(self, model: str, progress: Progress = silent) -> None:
        self._model = model
        self._session = _loaded(model, progress)

    def __reduce__(self) -> tuple[Callable[[str], OpenedNetwork], tuple[str]]:
        """Be copied by what it was loaded from."""
        return open_network, (self._model,)

    def get_inputs(self) -> Sequence[Tensor]:
        """Describe the inputs."""
        return self._session.get_inputs()

    def get_outputs(self) -> Sequence[Tensor]:
        """Describe the outputs."""
        return self._session.get_outputs()

    def get_modelmeta(self) -> Any:
        """Return what its author noted."""
        return self._session.get_modelmeta()

    def run(self, names: Sequence[str], inputs: Mapping[str, Array]) -> Sequence[Array]:
        """Compute the outputs of these names."""
        return self._session.run(names, inputs)


def open_network(model: str, progress: Progress = silent) -> OpenedNetwork:
    """Load a network; see `OpenedNetwork`."""
    return OpenedNetwork(model, progress)


def _loaded(model: str, progress: Progress) -> Network:
    os.environ.setdefault("ORT_DISABLE_TELEMETRY", "1")  # by default it reports to its makers
    try:
        runtime = importlib.import_module("onnxruntime")
    except ImportError:
        raise InputError(
            "networks need ONNX Runtime: install the extra [video], "
            "pip install 'vehicle_pf_tracker[video]'"
        ) from None
    path, _ = model_file(model, progress)
    options = runtime.SessionOptions()
    options.log_severity_level = 3  # errors: it warns of every unused weight
    try:
        network: Network = runtime.InferenceSession(
            str(path), options, providers=["CPUExecutionProvider"]
        )
    except Exception as error:  # ONNX Runtime's errors have no base of their own
        reason = " ".join(str(error).split())[:200]
        kept = discard(model)
        raise InputError(f"the network {model} cannot be loaded: {reason}{kept}") from None
    return network


@dataclass(frozen=True)
class _Same:
    """Makes a detector that keeps nothing between images: it is always the same."""

    detector: Detector

    def __call__(self) -> Detector:
        return self.detector


def detector_maker(
    parameters: DetectorParameters, progress: Progress = silent
) -> Callable[[], Detector] | None:
    """Return a function that makes the detector; None where there shall be none.

    Raises
    ------
    InputError
        If the network cannot be used.
    """
    if parameters.kind == MOTION:
        return MotionDetector
    if parameters.kind == MODEL:
        model = parameters.model
        return _Same(NetworkDetector(open_network(model, progress), model, parameters))
    return None


Run: TypeAlias = Callable[[Callable[[], Detections]], Detections]
"""Calls what makes detections, and returns them."""


def call(work: Callable[[], Detections]) -> Detections:
    """Call `work`, and return what it returns."""
    return work()


def every_image() -> int:
    """Return 1, for a detector that looks at every image."""
    return 1


class PacedDetector:
    """A detector that looks at every k-th image; what it found last, and how long that took.

    Parameters
    ----------
    detector : Detector
        The detector.
    wanted : callable
        Returns k, which may change; 0 chooses the smallest that keeps the rate of the images.
    run : callable
        Calls the detector.

    Attributes
    ----------
    every : int
        k in use, which differs between machines where it is chosen.
    found : int
        Number of detections in the last image that it looked at.
    seconds : float
        Time that they took, s.
    disturbed, is_blind : bool
        See `Detector`.
    """

    def __init__(
        self, detector: Detector, wanted: Callable[[], int] = every_image, run: Run = call
    ) -> None:
        self._detector = detector
        self._run = run
        self._wanted = wanted
        self.every = 1
        self.found = 0
        self.seconds = 0.0
        self.disturbed = self.is_blind = False
        self._images = 0
        self._others = 0.0

    def detect(self, frame: Frame, tracks: Sequence[FollowedVehicle] = ()) -> Detections:
        """Find vehicles, if it is this image's turn; see `Detector`."""
        self._images += 1
        self.every = self._wanted() or self.every
        self.disturbed = False
        self.is_blind = self._images > 1 and self._images <= self.every
        if self.is_blind:
            return Detections.make([], [])
        self._images = 1
        began = time.perf_counter()
        found = self._run(partial(self._detector.detect, frame, tracks))
        self.found = len(found)
        self.seconds = time.perf_counter() - began
        self.disturbed = self._detector.disturbed
        self.is_blind = self._detector.is_blind
        return found

    def pace(self, seconds: float, period: float) -> None:
        """Take the time that the last image cost in all, and the images' period, s."""
        others = seconds - (self.seconds if self._images == 1 else 0.0)
        self._others += (others - self._others) * (_RECENT if self._others else 1.0)
        if self._wanted() == 0:
            most = max(round(_LONGEST / period), 1)
            left = _SHARE * period - self._others
            least = math.ceil(self.seconds / left) if left > 0 else most
            self.every = min(max(least, 1), most)


_LAST_FRAME = 10**9
"""Largest number of a frame: a year of video."""


class DetectionFile:
    """Detections by the number of their frame.

    Parameters
    ----------
    path : Path
        Text file with a row per detection: frame from 1, id (not used), left, top, width and height
        in px, score (1 where it is missing); columns after these are not used. Rows may be in any
        order.

    Attributes
    ----------
    notices : list of str
        Irregularities, a sentence each.

    Raises
    ------
    InputError
        If it cannot be read, or a row is not of this form; the row is named by its number.
    """

    def __init__(self, path: Path) -> None:
        numbers = array("d")  # 48 bytes per row: a list of a million rows would take ten times that
        text = read_text(path, "the detections")
        for where, cells in table_rows(path, text, 6, "the detections"):
            frame, _, *box = numbers_in(where, cells[:7])
            if not (1 <= frame <= _LAST_FRAME and frame.is_integer()):
                raise InputError(f"{where} has the frame {frame:g}; frames are integers from 1")
            numbers.extend((frame, *box[:4], box[4] if len(box) > 4 else 1.0))
        rows: Array = np.frombuffer(numbers, np.float64).reshape(-1, 6)
        rows = rows[np.argsort(rows[:, 0], kind="stable")]
        self.notices: list[str] = []
        usable = np.isfinite(rows).all(axis=1) & (rows[:, 3:5] > 0).all(axis=1)
        if not usable.all():
            self.notices.append(
                f"{np.count_nonzero(~usable)} of {len(rows)} detections in {path} have no area, or "
                "numbers that are not finite, and are left out"
            )
        self._path = path
        self._frames = rows[usable, 0]
        self._rows = rows[usable, 1:]

    def misfit(self, size: tuple[int, int]) -> str:
        """Return why the boxes do not fit images of a size (px); empty where they do."""
        found = misfit(self._rows[:, :4], size)
        return f"the detections {self._path}: {found.sentence}" if found else ""

    def of(self, frame: int) -> Detections:
        """Return the detections of a frame; one without rows is one without vehicles."""
        begin, end = np.searchsorted(self._frames, [frame, frame + 1])
        return Detections.make(self._rows[begin:end, :4], self._rows[begin:end, 4])
