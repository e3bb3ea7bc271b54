# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Detection by a network that somebody else has loaded."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.clock import DEFAULT_PERIOD
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.detection import network_classes
from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.detection.detector import FollowedVehicle
from vehicle_pf_tracker.detection.network import Network
from vehicle_pf_tracker.detection.network_input import PADDING_GREY, Fit, letterboxed, stretched
from vehicle_pf_tracker.detection.network_outputs import (
    SSD,
    YOLOV8,
    YOLOX,
    NetworkBoxes,
    class_count,
    decode,
    form_of,
)
from vehicle_pf_tracker.detection.parameters import DetectorParameters

_TYPES: Mapping[str, Any] = {
    "tensor(float)": np.float32,
    "tensor(float16)": np.float16,
    "tensor(uint8)": np.uint8,
}
"""Types of inputs, by ONNX Runtime's names."""
_LARGEST_INPUT = 4096
"""Longest side of an input, px, as of `detector.input_size`: one of 20 000 px takes 12 GB."""
_CELL = 32
"""Size of the largest cells of most networks, px: an open input's sides are multiples of it."""
_MOST_BOXES = 3000
"""Best boxes of which overlapping ones are suppressed; that takes the square of their number. A
choice, ten times `MOST_DETECTIONS`: those that are suppressed are among them."""


class NetworkDetector:
    """Detector by a network, whose form is recognised by its outputs.

    Boxes that overlap are suppressed across classes, since a van that is a car and a truck at once
    is one vehicle.

    Parameters
    ----------
    network : Network
        The network.
    name : str
        Name of the network in errors, such as its file.
    parameters : DetectorParameters
        Classes and thresholds.

    Attributes
    ----------
    form : str
        ``YOLOX``, ``YOLOv8`` or ``SSD``.
    disturbed, is_blind : bool
        False: it looks at every image.

    Raises
    ------
    InputError
        If the network has another form, or no such classes.
    """

    def __init__(self, network: Network, name: str, parameters: DetectorParameters) -> None:
        self.disturbed = self.is_blind = False
        self._parameters = parameters
        self._network = network
        self._name = name
        self._input, self._type, self._is_planar, self._fixed = self._read_input()
        size = self._size(parameters.input_size, parameters.input_size)
        # One run on grey: many files leave the shapes of their outputs open.
        outputs = self._run(np.full((size[1], size[0], 3), PADDING_GREY, np.uint8))
        try:
            self.form = form_of(outputs, *size)
            self._names = self._class_names(class_count(self.form, outputs))
            self._classes = self._chosen_classes()
        except InputError as error:
            raise InputError(f"the network {self._name}: {error}") from None

    def detect(
        self,
        frame: Frame,
        tracks: Sequence[FollowedVehicle] = (),
        period: float = DEFAULT_PERIOD,
    ) -> Detections:
        """Find vehicles; `tracks` and `period` are not used."""
        picture, fit = self._fitted(frame)
        decoded = decode(self.form, self._run(picture), *frame_size(picture))
        # Filter before suppression: a box of a person is not to suppress a car's.
        boxes, scores, classes = self._filtered(decoded)
        kept = self._without_overlaps(boxes, scores)
        labels = [self._names.get(int(number), str(number)) for number in classes[kept]]
        return Detections.make(fit.to_image(boxes[kept]), scores[kept], labels)

    def _read_input(self) -> tuple[str, Any, bool, tuple[int | None, int | None]]:
        """Return name and type of the input, whether its colours are planes, and its fixed size."""
        inputs = self._network.get_inputs()
        shape = list(inputs[0].shape)
        is_image = len(inputs) == 1 and len(shape) == 4 and inputs[0].type in _TYPES
        is_planar = is_image and shape[1] == 3
        if not is_image or not (is_planar or shape[3] == 3):
            raise InputError(
                f"the network {self._name} takes no images: its one input must be (1, 3, height, "
                f"width) or (1, height, width, 3), and is {shape}"
            )
        sides = shape[2:4] if is_planar else shape[1:3]
        height, width = (side if isinstance(side, int) and side > 0 else None for side in sides)
        if isinstance(shape[0], int) and shape[0] > 1:
            raise InputError(
                f"the network {self._name} takes {shape[0]} images at once; export it with a "
                "batch of 1"
            )
        if max(height or 0, width or 0) > _LARGEST_INPUT:
            raise InputError(
                f"the network {self._name} takes images of {width}x{height} px; export it with "
                f"{_LARGEST_INPUT} px a side at most"
            )
        return inputs[0].name, _TYPES[inputs[0].type], is_planar, (width, height)

    def _size(self, across: int, down: int) -> tuple[int, int]:
        """Return width and height of the input for an image of this size, px."""
        # The longer side is the wanted one; both are rounded to cells, as the network halves them.
        scale = self._parameters.input_size / max(across, down)
        free = [max(1, round(side * scale / _CELL)) * _CELL for side in (across, down)]
        return self._fixed[0] or free[0], self._fixed[1] or free[1]

    def _fitted(self, frame: Frame) -> tuple[Frame, Fit]:
        width, height = self._size(*frame_size(frame))
        if self.form == SSD:
            return stretched(frame, width, height)
        return letterboxed(frame, width, height, centred=self.form == YOLOV8)

    def _run(self, picture: Frame) -> dict[str, Array]:
        """Run the network on an image of its input's size."""
        form = getattr(self, "form", None)  # not known before the first run
        # YOLOX was trained on BGR as OpenCV reads it, the others on RGB.
        pixels = picture[:, :, ::-1] if form == YOLOX else picture
        values = pixels.astype(self._type)
        # Real numbers are 0 to 1, but for YOLOX, which takes levels.
        if self._type is not np.uint8 and form != YOLOX:
            values = values / self._type(255)
        if self._is_planar:
            values = values.transpose(2, 0, 1)
        names = [output.name for output in self._network.get_outputs()]
        batch = np.ascontiguousarray(values[None], dtype=self._type)
        try:
            outputs = self._network.run(names, {self._input: batch})
        except Exception as error:  # ONNX Runtime's errors have no base of their own
            reason = " ".join(str(error).split())[:200]
            raise InputError(f"the network {self._name} cannot be run: {reason}") from None
        return dict(zip(names, outputs, strict=True))

    def _class_names(self, count: int | None) -> dict[int, str]:
        """Return the names of the classes by their numbers; empty where none are known."""
        # A user's names win, then the file's, then those that the form or the count implies.
        words = [word.strip() for word in self._parameters.names.split(",") if word.strip()]
        if words:
            if count is not None and len(words) != count:
                raise InputError(f"it has {count} classes, and detector.names {len(words)} names")
            return network_classes.numbered(tuple(words))
        metadata = self._network.get_modelmeta().custom_metadata_map
        in_file = network_classes.parse_metadata(metadata.get("names", ""))
        if in_file:
            return in_file
        if self.form == SSD:
            return network_classes.coco_from_one()
        if count == len(network_classes.COCO):
            return network_classes.numbered(network_classes.COCO)
        if count == 1:
            return {0: ""}
        raise InputError(f"it has {count} classes without names; give them with detector.names")

    def _chosen_classes(self) -> frozenset[int]:
        """Return the numbers of the classes that are vehicles; empty for all."""
        if len(self._names) == 1:
            return frozenset()
        words = self._parameters.classes
        if words == DetectorParameters().classes:  # a network need not know all of these
            known = [word for word in words.split(",") if word in self._names.values()]
            words = ",".join(known) or words
        return network_classes.chosen(words, self._names)

    def _filtered(self, decoded: NetworkBoxes) -> tuple[Array, Array, npt.NDArray[np.int64]]:
        """Return boxes, scores and classes of usable boxes of the chosen classes, best first."""
        usable = np.isfinite(decoded.boxes).all(axis=1) & (decoded.boxes[:, 2:] > 0).all(axis=1)
        # Above zero, the score of rows that had numbers without meaning.
        usable &= decoded.scores >= max(self._parameters.min_score, 1e-9)
        if self._classes:
            usable &= np.isin(decoded.classes, sorted(self._classes))
        kept = np.flatnonzero(usable)
        kept = kept[np.argsort(-decoded.scores[kept], kind="stable")][:_MOST_BOXES]
        return decoded.boxes[kept], decoded.scores[kept], decoded.classes[kept]

    def _without_overlaps(self, boxes: Array, scores: Array) -> list[int]:
        """Return the indices of the boxes that no better one overlaps."""
        kept = cv2.dnn.NMSBoxes(boxes.tolist(), scores.tolist(), 0.0, self._parameters.overlap)
        return sorted(int(index) for index in np.asarray(kept).ravel())
