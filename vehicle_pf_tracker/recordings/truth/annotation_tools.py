# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Truth of annotation tools: CVAT's XML and Label Studio's JSON."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator, Mapping
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Occlusion
from vehicle_pf_tracker.recordings.text_tables import number_of
from vehicle_pf_tracker.recordings.truth.labels import (
    ABSENT_SIDES,
    OTHER_SHAPES,
    Images,
    Label,
    UnreadTruthError,
)

_CVAT_SHAPES = {"box", "polygon", "polyline", "points", "ellipse", "mask", "cuboid", "skeleton"}
_STUDIO_SHAPES = ("polygon", "ellipse", "brush", "keypoint", "vector", "bitmask")
"""Shapes of the tools' exports; tags, choices and texts are none."""
_FULL_TURN = 360
"""Degrees of a rotation that turns a box into itself."""
_SHOWN = 60
"""Letters of an id that an error shows: a line of a terminal has 80."""


def cvat(path: Path, text: str, images: Images) -> Iterator[Label]:
    """Read CVAT's XML, "for video" with tracks and "for images"; frames and pixels count from 0.

    ``outside`` is absent. Boxes between key frames are in the export (docs.cvat.ai, XML annotation
    format).
    """
    try:
        root = ElementTree.fromstring(text)  # noqa: S314 - expat bounds what entities expand to
    except ElementTree.ParseError as error:
        raise UnreadTruthError(f"{path} is not whole XML: {error}") from error
    # Without tracks nothing says which of several boxes is the vehicle of the image before.
    if any(len(image.findall("box")) > 1 for image in root.iter("image")):
        raise UnreadTruthError(f"{path} has several boxes in an image, and no tracks")
    # Other shapes are given, too, each with its fault: a target would vanish without a word.
    for parent in root.iter():
        for shape in parent.findall("*") if parent.tag in ("track", "image") else ():
            if shape.tag in _CVAT_SHAPES:
                yield _cvat_label(parent, shape, path, images)


def _cvat_label(
    parent: ElementTree.Element, shape: ElementTree.Element, path: Path, images: Images
) -> Label:
    where = f"{parent.tag} {parent.get('id', '')[:_SHOWN]} of the truth {path}"
    stated = {**parent.attrib, **shape.attrib}
    names = ("id", "frame", "xtl", "ytl", "xbr", "ybr", "occluded", "outside", "rotation")
    values = {name: number_of(where, name, stated.get(name)) for name in names}
    identity = values["id"]
    index = values["frame"]
    # In "for images" the id is the image's, and counts from 0; its box has none, and is the only.
    if parent.tag == "image":
        identity, index = 1 if shape.tag == "box" else OTHER_SHAPES, identity
    # By name where the file has one, as the names of a folder may not be numbers; else by index.
    number = images.names.get(stated.get("name", "").rpartition("/")[2])
    if number is None and index.is_integer():
        number = images.nth(int(index))
    left = values["xtl"]
    top = values["ytl"]
    sides = (left, top, values["xbr"] - left, values["ybr"] - top)
    # CVAT writes the end of a track as a box that is outside: no position to trust.
    if is_absent := values["outside"] == 1:
        sides = ABSENT_SIDES
    return Label(
        where,
        math.nan if number is None else number,
        sides,
        Occlusion.PARTIAL if values["occluded"] == 1 else Occlusion.NONE,
        identity,
        "" if is_absent else _fault(shape.tag, values["rotation"]),
    )


def _fault(shape: str, rotation: float) -> str:
    """Return why a shape is not read; the one rule of all tools: upright boxes are."""
    if shape != "box":
        return f"is a {shape}; only upright boxes are read"
    is_upright = math.isnan(rotation) or rotation % _FULL_TURN == 0
    return "" if is_upright else "is rotated; only upright boxes are read"


def label_studio(path: Path, text: str, images: Images) -> Iterator[Label]:
    """Read Label Studio's export as JSON: rectangles of a video, or of images, one task each.

    Coordinates are in percent of the image (labelstud.io/tags/rectanglelabels).
    """
    try:
        yield from _studio_labels(path, json.loads(text), images)
    except InputError:
        raise
    # ValueError: also integers of thousands of digits; OverflowError: those of hundreds.
    except (ValueError, LookupError, TypeError, AttributeError, ArithmeticError, RecursionError):
        raise UnreadTruthError(f"{path} is not Label Studio's export as JSON") from None


def _studio_labels(path: Path, document: Any, images: Images) -> Iterator[Label]:
    width, height = images.size()
    for task in document:
        done = [made["result"] for made in task["annotations"] if not made.get("was_cancelled")]
        # The first annotator's: the tool exports all, and a mean of two boxes is nobody's truth.
        regions = (done or [[]])[0]
        # Other shapes have no number of their own here: one fault stands for all of them.
        for region in regions:
            where = f"a region of the truth {path}"
            kind = next((shape for shape in _STUDIO_SHAPES if shape in region["type"]), None)
            if kind is not None:
                fault = _fault(kind, math.nan)
                yield Label(where, math.nan, ABSENT_SIDES, identity=OTHER_SHAPES, fault=fault)
        rectangles = [region for region in regions if "rectangle" in region["type"]]
        for identity, region in enumerate(rectangles, start=1):
            where = f"region {identity} of the truth {path}"
            value = region["value"]
            is_video = "sequence" in value
            boxes = _key_frames if is_video else partial(_named, task["data"])
            for number, box in boxes(value, images):
                x, w = (box[name] * width / 100 for name in ("x", "width"))
                y, h = (box[name] * height / 100 for name in ("y", "height"))
                fault = _fault("box", float(box.get("rotation") or 0))
                yield Label(where, number, (x, y, w, h), identity=identity, fault=fault)


def _named(
    data: Mapping[str, Any], value: Mapping[str, Any], images: Images
) -> Iterator[tuple[int, Mapping[str, Any]]]:
    """Yield the number of the image that a task names, perhaps with a prefix, and the box."""
    # Uploaded files get a random prefix and a dash, and local ones a path or a query.
    words = [word for field in data.values() for word in re.split(r"[/=]", str(field))]
    names = (name for word in words for name in (word, word.partition("-")[2]))
    for name in [name for name in names if name in images.names][:1]:
        yield images.names[name], value


def _key_frames(
    value: Mapping[str, Any], images: Images
) -> Iterator[tuple[int, Mapping[str, Any]]]:
    """Yield the numbers of a video's frames, which count from 1, and a region's boxes in them.

    A box moves linearly from one key frame to the next, but ends at one that is not ``enabled``.
    Frames that a file names and the video does not have are left out, however many.
    """
    count = len(images.numbers)
    # Bounded by the frames there are: a file may say 10^9.
    last = min(value.get("framesCount") or 0, count)
    for now, following in pairwise([*value["sequence"], None]):
        frame = now["frame"]
        # From the last key frame the box stands still to the end of the video.
        end = following["frame"] if following else max(last, frame) + 1
        # One that is not enabled is the last frame in which the box is there.
        end_shown = end if now["enabled"] else frame + 1
        for at in range(max(frame, 1), min(end_shown, count + 1)):
            share = (at - frame) / max(end - frame, 1) if following else 0.0
            then = following or now
            names = ("x", "y", "width", "height")
            place = {name: now[name] + share * (then[name] - now[name]) for name in names}
            yield images.nth(at - 1), {**place, "rotation": now.get("rotation", 0)}
