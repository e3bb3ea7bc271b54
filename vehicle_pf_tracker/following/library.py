# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""One vehicle for Python programs and notebooks: a source in, a table of estimates out."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field, fields, replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.following.offline_tracker import OfflineTracker
from vehicle_pf_tracker.parameters.table import from_mapping
from vehicle_pf_tracker.recordings.source import frame_at, open_source
from vehicle_pf_tracker.recordings.truth.files import Beside
from vehicle_pf_tracker.results.estimates import (
    EstimateRow,
    start_of_clock,
    summary,
    write_estimates,
)
from vehicle_pf_tracker.showing.target_drawing import Annotator, frame_with_targets
from vehicle_pf_tracker.trackers.estimate import Estimate
from vehicle_pf_tracker.trackers.registry import find_variant

_NO_PARTICLES = np.zeros((0, 2))
"""Empty cloud in place of the particles: those of an hour of video would take 400 MB."""


@dataclass(frozen=True, slots=True)
class ShownEstimate:
    """An estimate drawn on its frame.

    Attributes
    ----------
    row : EstimateRow
        The estimate.
    picture : (H, W, 3) array
        The frame with box, path and mode, RGB.
    """

    row: EstimateRow
    picture: Frame = field(repr=False)

    def _repr_html_(self) -> str:
        png = cv2.imencode(".png", np.ascontiguousarray(self.picture[:, :, ::-1]))[1]
        return f'<img src="data:image/png;base64,{b64encode(png.tobytes()).decode()}">'


@dataclass(frozen=True, slots=True, repr=False)
class Estimates(Sequence[EstimateRow]):
    """Estimates of one vehicle, a row for each frame of a source.

    Attributes
    ----------
    source : str or Path
        The source.
    rows : tuple of EstimateRow
        The rows, in the order of the frames.
    notices : tuple of str
        Irregularities, a sentence each.
    """

    source: str | Path
    rows: tuple[EstimateRow, ...]
    notices: tuple[str, ...]
    _estimates: tuple[Estimate | None, ...]

    def __len__(self) -> int:
        return len(self.rows)

    def __getitem__(self, index: Any) -> Any:
        return self.rows[index]

    def __repr__(self) -> str:
        return f"<Estimates: {summary(self.rows)}>"

    def to_csv(self, path: str | Path) -> None:
        """Write the table as `run` writes ``estimates.csv``.

        Raises
        ------
        InputError
            If it cannot be written.
        """
        write_estimates(Path(path), self.rows)

    def to_pandas(self) -> Any:
        """Return the table as a data frame of pandas, with NaN where there is no estimate."""
        from pandas import DataFrame  # noqa: PLC0415 - no dependency of ours

        return DataFrame(map(asdict, self.rows))

    def show(self, number: int) -> ShownEstimate:
        """Draw the estimate of frame `number`, from 1, which is read from the source again.

        Raises
        ------
        InputError
            If there is no such frame, or it cannot be read.
        """
        # Read again: a film of an hour does not fit into memory.
        frame = frame_at(open_source(self.source, beside=Beside.IGNORED), number)
        annotator = Annotator()
        row = self.rows[number - 1]
        # The path drawn behind the vehicle is that of all frames before.
        for estimate in self._estimates[:number]:
            annotator.follow(estimate)
        states = [(annotator, row, self._estimates[number - 1])]
        start_ns = self.rows[0].stamp_ns
        # The clock begins again where stamps go back, as in the videos.
        for earlier in self.rows[:number]:
            start_ns = start_of_clock(start_ns, earlier.stamp_ns)
        elapsed_ns = row.stamp_ns - start_ns
        return ShownEstimate(row, frame_with_targets(frame, elapsed_ns, states))

    def _repr_html_(self) -> str:
        last = max((row.frame for row in self.rows if row.box is not None), default=0)
        return f"<p>{summary(self.rows)}</p>{self.show(last)._repr_html_() if last else ''}"


def track(
    source: str | Path,
    target: Box | Sequence[float] | None = None,
    variant: str = "fusion",
    **parameters: Any,
) -> Estimates:
    """Follow one vehicle through a source, as the verb ``run`` does.

    Parameters
    ----------
    source : str or Path
        As for `open_source`.
    target : Box or four numbers, optional
        Box of the vehicle in the first frame: left, top, width and height in px. None: the first
        true box of the source.
    variant : str
        Name in the registry.
    **parameters : Any
        Parameters that differ from the defaults, as for `make_tracker`.

    Raises
    ------
    InputError
        If the source cannot be read, there is no such variant or parameter, a value does not fit,
        or there is no target.
    """
    chosen = find_variant(variant)
    opened = open_source(source, beside=Beside.NOTED)
    truth = next(iter(opened.truth()), None)
    if target is None and truth is None:
        seen = "".join(f"; {sentence}" for sentence in opened.notices)
        raise InputError(f"{source} has no truth to start on; give the vehicle's box{seen}")
    if target is not None and not isinstance(target, Box):
        if len(target) != len(fields(Box)):
            raise InputError(f"the target {target} is not left, top, width and height in px")
        target = Box(*target)
    given = from_mapping(chosen.parameters, parameters)
    targets = {1: target} if target else {}
    # A target given by hand goes before the truth.
    first_truth = None if target else truth
    tracker = OfflineTracker(chosen, given, first_truth=first_truth, targets=targets)
    rows = []
    estimates = []
    for row in tracker.rows((image.stamp_ns, image.frame) for image in opened.frames()):
        rows.append(row)
        estimate = tracker.estimate
        # Without its particles: only the path is drawn later.
        light = estimate and replace(estimate, particles=_NO_PARTICLES, weights=_NO_PARTICLES[:, 0])
        estimates.append(light)
    notices = (*opened.notices, *tracker.notices)
    return Estimates(source, tuple(rows), notices, tuple(estimates))
