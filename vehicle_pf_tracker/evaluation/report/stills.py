# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Stills of the worst frames of a report's first system, with the truth and the others' boxes.

They are cut from the recordings once and kept in the folder, so that the report can be written
again without them.
"""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.evaluation.evaluation_folder import Source
from vehicle_pf_tracker.evaluation.line_styles import LINE_STYLES
from vehicle_pf_tracker.evaluation.report.aggregates import Aggregates
from vehicle_pf_tracker.evaluation.report.figures import styled
from vehicle_pf_tracker.evaluation.report.scored_runs import ScoredEvaluation
from vehicle_pf_tracker.recordings.recording_names import is_url
from vehicle_pf_tracker.recordings.source import open_source
from vehicle_pf_tracker.results.output_files import make_folder, replacing
from vehicle_pf_tracker.showing.drawing import draw_box, line_width, write_line

FOLDER = "stills"
"""Folder of the stills in that of the evaluation."""
_STILLS = 9
"""Stills on a page: three rows, a quarter of a megabyte."""
_FRAMES_APART = 30
"""Frames between two stills of a recording: those beside each other show the same failure."""
_WIDTH = 480
"""Width of a still, px: a third of the page, at twice its pixels."""
_QUALITY = 80
"""Quality of JPEG: a choice between blocks around the drawn edges and the size of the page."""
_TRUTH = (255, 255, 255)
"""Colour of the true box: white, which no system has (`line_styles.LINE_STYLES`)."""


@dataclass(frozen=True, slots=True)
class Moment:
    """One of the worst frames.

    Attributes
    ----------
    source : Source
        Recording that it is a frame of.
    frame : int
        Number of the frame, from 1.
    error : float
        Error of the first system there, px, median over its seeds.
    boxes : tuple of (str, Box)
        Labels of the systems with a style, each with the box of its first seed.
    truth : Box
        The true box.
    """

    source: Source
    frame: int
    error: float
    boxes: tuple[tuple[str, Box], ...]
    truth: Box

    @property
    def file(self) -> str:
        """Name of the still, which changes with what it shows."""
        shown = f"{self.source.digest} {self.frame} {self.boxes} {self.truth}"
        digest = hashlib.sha256(shown.encode()).hexdigest()[:12]
        return f"{self.source.name}-{self.frame}-{digest}.jpg"


def worst_moments(evaluation: ScoredEvaluation, aggregates: Aggregates) -> list[Moment]:
    """Return the frames in which the first system errs most, in sizes of the vehicle."""
    if not aggregates.order:
        return []
    found = []
    for source in evaluation.folder.recordings:
        runs = evaluation.of(source.name, aggregates.order[0])
        truths = evaluation.truths[source.name]
        if not runs:
            continue
        # The median over the seeds, so that no single unlucky run fills the page.
        errors = np.median([run.errors for run in runs], axis=0)
        # In diagonals of the vehicle: px would show near vehicles only.
        relative = np.full(len(errors), -np.inf)
        for frame, truth in truths.items():
            if frame <= len(errors) and np.isfinite(errors[frame - 1]):
                relative[frame - 1] = errors[frame - 1] / truth.box.diagonal
        found += [
            (relative[at], source, at + 1, float(errors[at]))
            for at in peaks(relative, _FRAMES_APART)
        ]
    found.sort(key=lambda moment: -moment[0])
    return [
        Moment(
            source,
            frame,
            error,
            _boxes(evaluation, aggregates, source.name, frame),
            evaluation.truths[source.name][frame].box,
        )
        for _, source, frame, error in found[:_STILLS]
    ]


def peaks(values: Array, apart: int) -> Iterator[int]:
    """Yield the indices of the largest finite values, at most `_STILLS`, each from its neighbours.

    Parameters
    ----------
    values : (N,) array
        Values; what is not finite is none.
    apart : int
        Number of values on each side of a peak that are passed over.
    """
    values = values.copy()
    for _ in range(_STILLS):
        index = int(np.argmax(values))
        if not np.isfinite(values[index]):
            return
        yield index
        # Its neighbours are out: they show the same failure.
        values[max(index - apart, 0) : index + apart + 1] = -np.inf


def _boxes(
    evaluation: ScoredEvaluation, aggregates: Aggregates, recording: str, frame: int
) -> tuple[tuple[str, Box], ...]:
    found = []
    for label in styled(aggregates):
        for run in evaluation.of(recording, label)[:1]:
            rows, _ = evaluation.folder.cell(recording, label, run.seed)
            box = next((row.box for row in rows if row.frame == frame), None)
            found += [(label, box)] if box is not None else []
    return tuple(found)


def write_stills(evaluation: ScoredEvaluation, aggregates: Aggregates) -> None:
    """Write the stills that the folder does not have, of the recordings that are here.

    Raises
    ------
    InputError
        If one cannot be written.
    """
    folder = evaluation.folder.path / FOLDER
    missing = [
        moment
        for moment in worst_moments(evaluation, aggregates)
        if not (folder / moment.file).exists()
    ]
    slots = styled(aggregates)
    for source in dict.fromkeys(moment.source for moment in missing):
        wanted = {moment.frame: moment for moment in missing if moment.source == source}
        for frame, picture in _frames(source, set(wanted)):
            _write(make_folder(folder) / wanted[frame].file, _drawn(picture, wanted[frame], slots))


def _frames(source: Source, wanted: set[int]) -> Iterator[tuple[int, Frame]]:
    """Yield the frames of a recording by their number; none where it is not here any more."""
    if is_url(source.path):  # a report fetches nothing
        return
    try:
        recording = open_source(source.path, topic=source.topic or None, identity=source.identity)
        for number, found in enumerate(recording.frames(), start=1):
            if number in wanted and found.frame is not None:
                yield number, found.frame
            if number >= max(wanted):
                return
    except InputError:
        return


def _drawn(frame: Frame, moment: Moment, slots: dict[str, int]) -> Frame:
    """Draw the true box dashed in white, and each system's in its colour."""
    # Scaled before it is drawn on: lines and letters keep their widths.
    scale = _WIDTH / frame.shape[1]
    method = cv2.INTER_AREA if scale < 1 else cv2.INTER_LINEAR
    scaled = cv2.resize(frame, None, fx=scale, fy=scale, interpolation=method)
    picture: Frame = np.ascontiguousarray(scaled, np.uint8)
    width = 2 * line_width(picture)
    for label, box in reversed(moment.boxes):  # the first on top
        code = LINE_STYLES[slots[label]].colour
        red, green, blue = (int(code[at : at + 2], 16) for at in (1, 3, 5))
        draw_box(picture, _scaled(box, scale), (red, green, blue), width)
    draw_box(picture, _scaled(moment.truth, scale), _TRUTH, line_width(picture), dashed=True)
    write_line(picture, f"frame {moment.frame}", _TRUTH)
    return picture


def _scaled(box: Box, scale: float) -> Box:
    return Box(box.x * scale, box.y * scale, box.width * scale, box.height * scale)


def _write(path: Path, picture: Frame) -> None:
    _, coded = cv2.imencode(
        ".jpg", cv2.cvtColor(picture, cv2.COLOR_RGB2BGR), (cv2.IMWRITE_JPEG_QUALITY, _QUALITY)
    )
    with replacing(path) as partial:
        partial.write_bytes(coded.tobytes())


def embedded_stills(evaluation: ScoredEvaluation, aggregates: Aggregates) -> list[dict[str, str]]:
    """Return the stills that the folder has, as addresses that hold them, with their captions."""
    folder = evaluation.folder.path / FOLDER
    return [
        {
            "address": "data:image/jpeg;base64,"
            + base64.b64encode((folder / one.file).read_bytes()).decode(),
            "caption": f"{one.source.name}, frame {one.frame}: {one.error:.0f} px",
        }
        for one in worst_moments(evaluation, aggregates)
        if (folder / one.file).exists()
    ]
