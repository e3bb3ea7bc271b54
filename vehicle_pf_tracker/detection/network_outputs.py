# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Outputs of detection networks, recognised by names and shapes.

=========  ================================================  =======================================
form       outputs                                           input it is given
=========  ================================================  =======================================
`YOLOX`    one, (1, N, 5 + classes): centre, size, score of  BGR from 0 to 255, in the upper left
           an object, scores of the classes                  corner of grey
`YOLOV8`   one, (1, 4 + classes, N): centre, size, scores    RGB from 0 to 1, in the middle of grey
`SSD`      several, whose names contain boxes, scores, and   RGB, stretched; bytes, or from 0 to 1
           classes or labels                                 where the input has real numbers
=========  ================================================  =======================================

N is the number of cells of 8, 16 and 32 px (and 64 px) that the input has.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.errors import InputError

YOLOX = "YOLOX"
YOLOV8 = "YOLOv8"
SSD = "SSD"

_STRIDES = ((8, 16, 32), (8, 16, 32, 64))
"""Sizes of cells in px of the networks in the table above: those of their usual exports."""
_RAW_CENTRE = 32.0
"""Largest centre of boxes, in cells or px, up to which YOLOX's boxes are relative to their cells,
as its own export leaves them: offsets of a few cells. In px, the last cell's centre is where the
input ends."""
_NORMALISED = 2.0
"""Largest coordinate up to which SSD's boxes are shares of the image; beyond it they are px. A
choice: shares of boxes over the border are a little above 1."""


@dataclass(frozen=True, slots=True)
class NetworkBoxes:
    """Boxes in the outputs of a network.

    Attributes
    ----------
    boxes : array, shape (N, 4)
        Left, top, width and height in px of its input.
    scores : array, shape (N,)
        Score of the best class.
    classes : integer array, shape (N,)
        Number of that class.
    """

    boxes: Array
    scores: Array
    classes: npt.NDArray[np.int64]


def form_of(outputs: Mapping[str, Array], width: int, height: int) -> str:
    """Recognise the form of a network's outputs for an input of this size in px.

    Raises
    ------
    InputError
        If it is none of those above.
    """
    # By names first: shapes of SSD's outputs differ between exports.
    if _ssd_names(list(outputs)) is not None:
        return SSD
    if len(outputs) == 1:
        (output,) = outputs.values()
        if output.ndim == 3 and output.shape[0] == 1:
            # One row for each cell: no other axis is likely to have just that number.
            counts = {len(_cells(width, height, strides)[0]) for strides in _STRIDES}
            if output.shape[1] in counts and output.shape[2] > 5:
                return YOLOX
            if output.shape[2] in counts and output.shape[1] > 4:
                return YOLOV8
    shapes = ", ".join(f"{name} {tuple(value.shape)}" for name, value in outputs.items())
    raise InputError(f"its outputs ({shapes}) are not those of YOLOX, YOLOv8 or SSD")


def class_count(form: str, outputs: Mapping[str, Array]) -> int | None:
    """Return the number of classes; None where the outputs leave it open."""
    if form == SSD:
        return None
    (output,) = outputs.values()
    return int(output.shape[2] - 5 if form == YOLOX else output.shape[1] - 4)


def decode(form: str, outputs: Mapping[str, Array], width: int, height: int) -> NetworkBoxes:
    """Read the outputs for an input of this size in px; a box with NaN or infinity scores 0."""
    if form == SSD:
        return _decode_ssd(outputs, width, height)
    (output,) = outputs.values()
    rows = _finite(output[0] if form == YOLOX else output[0].T)
    boxes = _placed(rows[:, :4], width, height) if form == YOLOX else rows[:, :4]
    # YOLOX multiplies the score of an object by that of its class; YOLOv8 has classes only.
    scores = rows[:, 5:] * rows[:, 4:5] if form == YOLOX else rows[:, 4:]
    classes = scores.argmax(axis=1)
    best = scores[np.arange(len(scores)), classes]
    corner = boxes[:, :2] - boxes[:, 2:] / 2
    return NetworkBoxes(np.hstack([corner, boxes[:, 2:]]), best, classes)


def _finite(rows: Array) -> Array:
    """Copy rows of boxes, those that have a number without meaning as zeros."""
    copied = np.array(rows, np.float64)
    copied[~np.isfinite(copied).all(axis=1)] = 0.0
    return copied


def _placed(boxes: Array, width: int, height: int) -> Array:
    """Place YOLOX's boxes that are relative to their cells; others stay as they are."""
    if not len(boxes) or float(np.abs(boxes[:, :2]).max()) > _RAW_CENTRE:
        return boxes
    for strides in _STRIDES:
        corners, sizes = _cells(width, height, strides)
        if len(corners) == len(boxes):
            with np.errstate(over="ignore"):  # a box without end is left out later
                return np.hstack([(boxes[:, :2] + corners) * sizes, np.exp(boxes[:, 2:]) * sizes])
    return boxes


def _cells(width: int, height: int, strides: Sequence[int]) -> tuple[Array, Array]:
    """Return column and row (N, 2) of every cell, and its size (N, 1) in px."""
    corners = []
    sizes = []
    for stride in strides:
        rows, columns = np.mgrid[: height // stride, : width // stride]
        corners.append(np.stack([columns.ravel(), rows.ravel()], axis=1).astype(np.float64))
        sizes.append(np.full((rows.size, 1), float(stride)))
    return np.concatenate(corners), np.concatenate(sizes)


def _ssd_names(names: Sequence[str]) -> tuple[str, str, str] | None:
    """Return the names of SSD's boxes, scores and classes; None where one is missing."""
    found = []
    for words in (("boxes",), ("scores",), ("classes", "labels")):
        fitting = [
            name
            for name in names
            if any(word in name.lower() for word in words) and "raw" not in name.lower()
        ]
        if not fitting:
            return None
        found.append(fitting[0])
    return found[0], found[1], found[2]


def _decode_ssd(outputs: Mapping[str, Array], width: int, height: int) -> NetworkBoxes:
    names = _ssd_names(list(outputs))
    assert names is not None, "it is SSD by these names"
    columns = [
        np.asarray(outputs[name]).reshape(-1, size)
        for name, size in zip(names, (4, 1, 1), strict=True)
    ]
    count = min(map(len, columns))
    rows = _finite(np.hstack([column[:count] for column in columns]))
    boxes = rows[:, :4]
    if names[0].startswith("detection_"):  # TensorFlow has y before x
        boxes = boxes[:, [1, 0, 3, 2]]
    if np.abs(boxes).max(initial=0.0) <= _NORMALISED:
        boxes = boxes * np.array([width, height, width, height])
    corners = np.hstack([boxes[:, :2], boxes[:, 2:] - boxes[:, :2]])
    return NetworkBoxes(corners, rows[:, 4], rows[:, 5].astype(np.int64))
