# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Many vehicles for Python programs: arrays in, frozen dataclasses out."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any, TypeVar

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame, check_frame, frame_size
from vehicle_pf_tracker.counting.crossing import Crossing
from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.detection.parameters import MODEL_DETECTOR
from vehicle_pf_tracker.following.counted_vehicles import CountedVehicles, session_and_counter
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.parameters.table import unknown_name
from vehicle_pf_tracker.recordings.box_sizes import MOST_BEYOND, misfit
from vehicle_pf_tracker.recordings.footage import check_fps
from vehicle_pf_tracker.results.traffic_results import mot_numbers
from vehicle_pf_tracker.trackers.image_stream import checked_stamp
from vehicle_pf_tracker.trackers.registry import TRAFFIC_VARIANT
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate, TrackMode

DetectionsT = TypeVar("DetectionsT")

_RGB = "rgb"
"""Order of an image's colours that is ours."""
_BGR = "bgr"
"""Order of the colours of images which OpenCV reads."""
_LTWH = "ltwh"
"""Form of a box: left, top, width, height."""
_XYXY = "xyxy"
"""Form of a box: left, top, right, bottom."""
_CXCYWH = "cxcywh"
"""Form of a box: centre, width, height."""
_JUDGED = 50
"""Boxes by which their form is judged, a choice: some images, in which not all vehicles leave."""
_ENOUGH = 5
"""Boxes, all of which could be two corners, of which one beyond the image is enough to warn. A
choice: as sizes, all are of vehicles in the upper left corner, wider than their way to it."""


class TrafficTracker(CountedVehicles):
    """Follow and count every vehicle of a stream of RGB images, or of BGR with ``colour="bgr"``.

    It can be deep-copied and pickled, as for a pool of processes or a checkpoint: the copy goes on
    with the same numbers.

    Parameters
    ----------
    frame_rate : float
        Images per second; stamps, where they are given, determine the time between two images.
    parameters : mapping of str to Any
        Parameters of `traffic`, by their names in its parameter file.
    lines : str or Path
        File of lines, zones and regions of interest.
    model : str or Path
        Network, a file or a URL, that looks for vehicles where no detections are given. Without
        one, what moves before the standing camera is looked for.
    colour : str
        Order of the images' colours: "rgb", or "bgr" as OpenCV reads them.

    Attributes
    ----------
    crossings : tuple of Crossing
        Crossings that the last image has added to the counts.

    Raises
    ------
    InputError
        If a parameter, the file of lines or the network cannot be used.
    """

    def __init__(
        self,
        frame_rate: float,
        parameters: Mapping[str, Any] = MappingProxyType({}),
        *,
        lines: str | Path = "",
        model: str | Path = "",
        colour: str = _RGB,
    ) -> None:
        self._is_bgr = _chosen(colour, "colour", (_RGB, _BGR)) == _BGR
        named = {"detector.kind": MODEL_DETECTOR, "detector.model": str(model)} if model else {}
        given = {"frame_rate": frame_rate, "lines": str(lines), **named, **parameters}
        known = (configuration := Configuration.of(TRAFFIC_VARIANT)).specs()
        if unknown := [unknown_name(name, known) for name in given if name not in known]:
            raise InputError("; ".join(unknown))
        super().__init__(*session_and_counter(configuration.updated(given)))
        self.crossings: tuple[Crossing, ...] = ()
        self._period_ns = round(1e9 / check_fps(frame_rate, "frame_rate"))
        self._stamp_ns = self._images = 0
        self._class_ids: dict[str, int] = {}
        self._is_warned = False
        self._boxes: Array = np.empty((0, 4))

    @property
    def withdrawn(self) -> tuple[Crossing, ...]:
        """Earlier crossings that the last image has taken back from the counts.

        They are of numbers that turned out to be another one's vehicle.
        """
        return self.counter.withdrawn

    def update(
        self,
        frame: Frame,
        boxes: npt.ArrayLike | None = None,
        scores: npt.ArrayLike | None = None,
        labels: Sequence[str] | None = None,
        *,
        format: str = _LTWH,  # noqa: A002 - the word that OpenCV's and torchvision's users know
        stamp_ns: int | None = None,
    ) -> tuple[TrackEstimate, ...]:
        """Follow all vehicles into the next image.

        Parameters
        ----------
        frame : Frame
            Image, bytes of the shape (height, width, 3), its colours in the order given to the
            constructor.
        boxes : array-like, shape (N, 4), optional
            Detections in px, in the form of `format`; empty where the detector saw nothing. None:
            the tracker looks for vehicles itself.
        scores : array-like, shape (N,), optional
            Their scores: from 0 to 1 the probability of a vehicle, by which one that stands is
            reported, too; else only their order counts. None: what stands is after 21 images.
        labels : sequence of str, optional
            Their classes.
        format : str
            "ltwh": left, top, width, height; "xyxy": left, top, right, bottom; "cxcywh": centre,
            width, height.
        stamp_ns : int, optional
            Stamp of the image in ns; None: one period after the image before.

        Returns
        -------
        tuple of TrackEstimate
            The confirmed vehicles that are visible or predicted, by `id`.

        Raises
        ------
        InputError
            If the image is not usable, or the stamp is no integer.
        ValueError
            If a box has not four numbers, the form is unknown, or there are not as many scores or
            labels as boxes. Boxes that seem to be of another form are warned of once.
        """
        _chosen(format, "format", (_LTWH, _XYXY, _CXCYWH))
        # Before the reshape, which would cut rows of five numbers into others.
        if boxes is not None and np.ndim(boxes) > 1 and np.shape(boxes)[-1] not in {0, 4}:
            raise ValueError("a box is left, top, width and height in px")
        check_frame(np.asarray(frame))
        frame = _swapped(frame) if self._is_bgr else frame
        # A library has no clock of its own: images are evenly spaced unless stamps say more.
        stamp_ns = self._stamp_ns + self._period_ns if stamp_ns is None else stamp_ns
        self._stamp_ns = checked_stamp(stamp_ns)
        self._images += 1
        detections = None
        if boxes is not None:
            detections = Detections.make(_sizes(boxes, format), scores, labels)
            self._check_form(detections.boxes, frame_size(frame))
        self.crossings = self.follow(frame, self._stamp_ns, detections)
        return tuple(each for each in self.estimates if each.id and each.mode is not TrackMode.LOST)

    def _check_form(self, boxes: Array, size: tuple[int, int]) -> None:
        """Warn once of boxes that are two corners, taken for sizes, or no px of this image."""
        if self._is_warned or len(self._boxes) >= _JUDGED:
            return
        # Gathered over images: a few boxes of one image may fit either form.
        self._boxes = np.concatenate([self._boxes, boxes])
        # A vehicle that drives in from the right reaches beyond the image, too, but not as corners.
        are_corners = (self._boxes[:, 2:] > self._boxes[:, :2]).all(axis=1)
        is_likely = are_corners.all() and len(self._boxes) >= _ENOUGH
        doubt = misfit(self._boxes, size, 0.0 if is_likely else MOST_BEYOND)
        if doubt is not None and (doubt.is_fatal or 2 * are_corners.sum() > len(self._boxes)):
            self._is_warned = True
            warnings.warn(f"{doubt.sentence} (format=)", stacklevel=3)

    def update_with_detections(
        self, frame: Frame, detections: DetectionsT, *, stamp_ns: int | None = None
    ) -> DetectionsT:
        """Follow all vehicles into the next image, with `supervision.Detections` in and out.

        Returns those of all vehicles that `update` returns, the occluded ones included, with
        `tracker_id`, and ``data`` with their ``class_name`` and ``mode``. Masks are not carried on.
        """
        given: Any = detections
        ids = given.class_id
        names = given.data.get("class_name", ids)
        labels = None if names is None else [str(name) for name in names]
        if labels is not None and ids is not None:
            # Learnt from what is given: supervision's ids are its user's, and ours are words.
            self._class_ids.update(zip(labels, map(int, ids), strict=True))
        scores = given.confidence
        form = _XYXY
        tracks = self.update(frame, given.xyxy, scores, labels, format=form, stamp_ns=stamp_ns)
        # -1: a class that no detection has had, as of a vehicle that was given by hand.
        known = [self._class_ids.get(track.label, -1) for track in tracks]
        followed: DetectionsT = type(given)(
            xyxy=np.array([[*track.box.corners[0], *track.box.corners[2]] for track in tracks])
            .reshape(-1, 4)
            .astype(np.float32),
            confidence=np.array([track.confidence for track in tracks], np.float32),
            class_id=np.array(known, int) if self._class_ids else None,
            tracker_id=np.array([track.id for track in tracks], int),
            data={
                "class_name": np.array([track.label for track in tracks], str),
                "mode": np.array([track.mode.value for track in tracks], str),
            },
        )
        return followed

    def update_with_rows(
        self, frame: Frame, rows: npt.ArrayLike, *, stamp_ns: int | None = None
    ) -> Array:
        """Follow all vehicles into the next image, with rows of MOTChallenge in and out.

        Parameters
        ----------
        frame : Frame
            Image, as for `update`.
        rows : array-like, shape (N, 6 or more)
            Detections of this image: frame, id (neither is used), left, top, width, height, and a
            score if there is one.
        stamp_ns : int, optional
            As for `update`.

        Returns
        -------
        array, shape (M, 10)
            Rows of ``tracks.txt``: the number of the image from 1, id, left, top, width, height,
            confidence (half of it of an occluded vehicle) and three times -1.
        """
        # Seven columns for no row, which has no width.
        given = np.asarray(rows, np.float64).reshape(-1, np.shape(rows)[-1] or 7)
        scores = given[:, 6] if given.shape[1] > 6 else None
        tracks = self.update(frame, given[:, 2:6], scores, stamp_ns=stamp_ns)
        numbers = [mot_numbers(self._images, track) for track in tracks]
        return np.array(numbers, np.float64).reshape(-1, 10)


def _chosen(value: str, name: str, known: Sequence[str]) -> str:
    """Return one of the known values.

    Raises
    ------
    ValueError
        If it is another.
    """
    if value not in known:
        raise ValueError(f"{name} is one of {', '.join(map(repr, known))}, not {value!r}")
    return value


def _sizes(boxes: npt.ArrayLike, form: str) -> Array:
    """Return boxes of a form (N, 4) by left, top, width and height, px."""
    numbers = np.asarray(boxes, np.float64).reshape(-1, 4)
    first = numbers[:, :2]
    second = numbers[:, 2:]
    if form == _XYXY:
        return np.hstack([first, second - first])
    return np.hstack([first - second / 2, second]) if form == _CXCYWH else numbers


def _swapped(frame: Frame) -> Frame:
    """Return a BGR image as RGB."""
    return np.asarray(cv2.cvtColor(np.asarray(frame), cv2.COLOR_BGR2RGB), np.uint8)
