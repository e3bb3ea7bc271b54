# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Recordings of images, truth and the estimates of trackers, for Foxglove or evo.

A run as a recording: images, truth, estimates and annotations, written while it tracks.

Estimates as annotations that Foxglove draws over the images: box, path and words by mode.

Lines and words over an image, as the message that Foxglove draws.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeAlias

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import frame_size
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.offline.drawing import COLOURS, NEUTRAL, line_width_of
from vehicle_pf_tracker.offline.estimates import EstimateRow
from vehicle_pf_tracker.recordings import messages
from vehicle_pf_tracker.recordings.cdr import IMAGE_ANNOTATIONS, message_class
from vehicle_pf_tracker.recordings.importing import jpeg
from vehicle_pf_tracker.recordings.messages import as_token
from vehicle_pf_tracker.recordings.reader import Recording, StampedFrame
from vehicle_pf_tracker.recordings.topics import (
    DIAGNOSTIC_ARRAY,
    POINT_STAMPED,
    POLYGON_STAMPED,
    TRUTH_TOPICS,
)
from vehicle_pf_tracker.recordings.writer import RecordingWriter
from vehicle_pf_tracker.trackers.estimate import Mode

LINE_LOOP, LINE_STRIP, LINE_LIST = 2, 3, 4
"""Ways to join points: to a closed line, to an open one, and in pairs."""

Point: TypeAlias = tuple[float, float]
"""Continuous position in px; (0, 0) is the corner of the image, as it is for Foxglove."""
Colour: TypeAlias = tuple[int, int, int]
"""Red, green, blue, 0 to 255."""

_GROUND_OPACITY = 0.6
"""Opacity of the black behind words: they are legible on a bright road, which stays visible."""


@dataclass(frozen=True, slots=True)
class Line:
    """A line: how its points are joined, the points, its colour, and its width in px."""

    kind: int
    points: Sequence[Point]
    colour: Colour
    thickness: float


@dataclass(frozen=True, slots=True)
class Label:
    """Words: their lower left corner, their colour, and the size of the font in px."""

    text: str
    corner: Point
    colour: Colour
    height: float


def image_annotations(stamp_ns: int, lines: Iterable[Line], labels: Iterable[Label]) -> Any:
    """Make the annotations of the image with this stamp in ns."""
    seconds, nanoseconds = divmod(stamp_ns, 1_000_000_000)
    stamp = message_class("builtin_interfaces/msg/Time")(sec=seconds, nanosec=nanoseconds)
    return message_class(IMAGE_ANNOTATIONS)(
        circles=[],
        points=[_points(stamp, line) for line in lines],
        texts=[_text(stamp, label) for label in labels],
    )


def _points(stamp: Any, line: Line) -> Any:
    return message_class("foxglove_msgs/msg/PointsAnnotation")(
        timestamp=stamp,
        type=line.kind,
        points=[_point(point) for point in line.points],
        outline_color=_colour(line.colour),
        outline_colors=[],
        fill_color=_colour((0, 0, 0), 0.0),
        thickness=line.thickness,
    )


def _text(stamp: Any, label: Label) -> Any:
    return message_class("foxglove_msgs/msg/TextAnnotation")(
        timestamp=stamp,
        position=_point(label.corner),
        text=label.text,
        font_size=label.height,
        text_color=_colour(label.colour),
        background_color=_colour((0, 0, 0), _GROUND_OPACITY),
    )


def _point(point: Point) -> Any:
    return message_class("foxglove_msgs/msg/Point2")(x=float(point[0]), y=float(point[1]))


def _colour(colour: Colour, opacity: float = 1.0) -> Any:
    red, green, blue = (value / 255 for value in colour)
    return message_class("foxglove_msgs/msg/Color")(r=red, g=green, b=blue, a=opacity)


_PATH_LENGTH = 60
"""Positions in a path. Every message repeats them: 60 cost 1 kB, and show two seconds of video."""
_DASH = 4
"""Length of a dash and of a gap, in line widths."""
_LETTERS = 12
"""Height of letters, in line widths."""


class ImageAnnotator:
    """Makes the annotations of one track; keeps its path.

    Every image gets words with the mode, so that a viewer which waits for annotations of the same
    stamp shows images without an estimate too.

    Parameters
    ----------
    name : str
        Name of the track in the words; may be empty.
    size : (int, int)
        Width and height of the images in px, which lines and letters grow with.
    position : int
        Number of the track, from 0: its line in the corner where words without a box stand.
    """

    def __init__(self, name: str, size: tuple[int, int], position: int = 0) -> None:
        self._name = name
        self._width = line_width_of(size)
        self._position = position
        self._path: deque[Point] = deque(maxlen=_PATH_LENGTH)

    def annotate(self, row: EstimateRow) -> Any:
        """Continue the path with `row`, and return the message for its image."""
        box = None if row.mode == Mode.LOST else row.box
        if box is None:
            self._path.clear()
            return image_annotations(row.stamp_ns, [], [self._words(row, None)])
        self._path.append(box.centre)
        return image_annotations(row.stamp_ns, self._lines(row, box), [self._words(row, box)])

    def _lines(self, row: EstimateRow, box: Box) -> Iterator[Line]:
        colour = COLOURS[row.mode]
        corners = [(float(x), float(y)) for x, y in box.corners]
        if row.mode == Mode.OCCLUDED:
            dashes = _dashes(corners, float(_DASH * self._width))
            yield Line(LINE_LIST, dashes, colour, self._width)
        else:
            yield Line(LINE_LOOP, corners, colour, self._width)
        if len(self._path) > 1:
            yield Line(LINE_STRIP, list(self._path), colour, self._width)

    def _words(self, row: EstimateRow, box: Box | None) -> Label:
        confidence = "" if row.confidence is None else f" {row.confidence:.2f}"
        text = f"{self._name} {row.mode}{confidence}".lstrip()
        height = float(_LETTERS * self._width)
        if box is None:
            corner = (height / 2, 1.5 * height * (self._position + 1))
        else:
            corner = (max(box.x, 0.0), max(box.y - 2.0 * self._width, height))
        return Label(text, corner, COLOURS.get(row.mode, NEUTRAL), height)


def _dashes(corners: Sequence[Point], dash: float) -> list[Point]:
    """Return the ends of the dashes of a closed line, in pairs."""
    ends: list[Point] = []
    for (x, y), (to_x, to_y) in zip(corners, [*corners[1:], corners[0]], strict=True):
        length = max(abs(to_x - x), abs(to_y - y))  # the sides of a box are level or upright
        for start in range(0, int(length / dash) + 1, 2):
            for along in (start * dash, min((start + 1) * dash, length)):
                share = along / length if length else 0.0
                ends.append((x + share * (to_x - x), y + share * (to_y - y)))
    return ends


_LEVELS = {Mode.OCCLUDED.value: messages.WARN, Mode.LOST.value: messages.ERROR}
"""Levels of the modes that are not OK."""


class EstimateTopics:
    """Writes estimates of several tracks to a recording, as nodes publish them, and annotations.

    Those of the track ``apf_tracker`` go to ``/apf_tracker/position``, ``box`` and ``mode``, and
    to ``/apf_tracker/annotations`` for Foxglove.

    Parameters
    ----------
    writer : RecordingWriter
        The recording.
    labels : mapping of str to str
        Names of the tracks as parts of topics, and the names that annotations show.
    size : (int, int)
        Width and height of the images, px.
    """

    def __init__(
        self, writer: RecordingWriter, labels: Mapping[str, str], size: tuple[int, int]
    ) -> None:
        self._writer = writer
        self._annotators = {
            name: ImageAnnotator(label if len(labels) > 1 else "", size, position)
            for position, (name, label) in enumerate(labels.items())
        }

    def write(self, name: str, row: EstimateRow) -> None:
        """Write one estimate of the track `name`, at the stamp of its image."""
        writer, stamp = self._writer, row.stamp_ns
        numbers = {"x": row.x, "y": row.y, "confidence": row.confidence, "n_eff": row.n_eff}
        values = {key: repr(value) for key, value in numbers.items() if value is not None}
        level = _LEVELS.get(row.mode, messages.OK)
        mode = messages.diagnostic_array(stamp, name, level, row.mode, values)
        writer.write(f"/{name}/mode", DIAGNOSTIC_ARRAY, stamp, mode)
        annotations = self._annotators[name].annotate(row)
        writer.write(f"/{name}/annotations", IMAGE_ANNOTATIONS, stamp, annotations)
        if row.position is None or row.box is None:
            return
        point = messages.point_stamped(stamp, *row.position)
        writer.write(f"/{name}/position", POINT_STAMPED, stamp, point)
        polygon = messages.polygon_stamped(stamp, row.box.corners)
        writer.write(f"/{name}/box", POLYGON_STAMPED, stamp, polygon)


def write_with_estimates(
    folder: Path,
    recording: Recording,
    runs: Mapping[str, Sequence[EstimateRow]],
    *,
    overwrite: bool = False,
) -> None:
    """Copy `recording` to `folder` with the estimates of `runs` beside it.

    Parameters
    ----------
    folder : Path
        The rosbag2 folder to write.
    recording : Recording
        The recording whose images and truth are copied as they are.
    runs : mapping of str to rows
        Estimates by node name; see `EstimateTopics`.
    overwrite : bool
        Replace a recording that is there.

    Raises
    ------
    InputError
        If the folder cannot be written.
    """
    rows = _by_stamp(runs)
    copied = {recording.image_topic, *TRUTH_TOPICS}
    with RecordingWriter(folder, overwrite=overwrite) as writer:
        labels = {name: name.removesuffix("_tracker") for name in runs}
        topics = EstimateTopics(writer, labels, _image_size(recording))
        for message in recording.messages(copied):
            stamp = message.log_time_ns if message.stamp_ns is None else message.stamp_ns
            writer.write_serialized(message.topic, message.type_name, stamp, message.data)
            if message.topic == recording.image_topic:
                for name, row in rows.pop(stamp, []):
                    topics.write(name, row)


def _by_stamp(
    runs: Mapping[str, Sequence[EstimateRow]],
) -> dict[int, list[tuple[str, EstimateRow]]]:
    table: dict[int, list[tuple[str, EstimateRow]]] = {}
    for name, rows in runs.items():
        for row in rows:
            table.setdefault(row.stamp_ns, []).append((name, row))
    return table


def _image_size(recording: Recording) -> tuple[int, int]:
    """Return the size of the first image that can be read; (0, 0) without any."""
    frames = (found.frame for found in recording.frames())
    first = next((frame for frame in frames if frame is not None), None)
    return (0, 0) if first is None else frame_size(first)


OnFrame: TypeAlias = Callable[[StampedFrame, Mapping[str, EstimateRow]], None]
"""Takes each frame with the row of each target."""


@contextmanager
def run_recording(
    folder: Path, node: str, targets: Sequence[str], truths: Sequence[Truth]
) -> Iterator[OnFrame]:
    """Write a run to the recording `folder`, which appears when the block ends well.

    Images are JPEG whatever the source has, since a video as pixels is a hundred times its size.

    Parameters
    ----------
    folder : Path
        The rosbag2 folder; a recording that is there is replaced.
    node : str
        Name of the variant's node. Topics begin with it, and with ``node/target`` for several.
    targets : sequence of str
        Names of the targets.
    truths : sequence of Truth
        Truth in the order of time, of which the part from the first frame on is written.

    Raises
    ------
    InputError
        If it cannot be written.
    """
    labels = {name: f"{node}/{as_token(name)}" for name in targets}
    if len(targets) == 1:
        labels = dict.fromkeys(targets, node)
    with RecordingWriter(folder, overwrite=True) as writer:
        topics: EstimateTopics | None = None
        waiting = list(reversed(truths))

        def keep(found: StampedFrame, rows: Mapping[str, EstimateRow]) -> None:
            nonlocal topics
            is_first = topics is None
            if found.frame is None:
                return
            if topics is None:
                shown = {topic: name for name, topic in labels.items()}
                topics = EstimateTopics(writer, shown, frame_size(found.frame))
            writer.write_compressed(found.stamp_ns, "jpeg", jpeg(found.frame))
            while waiting and waiting[-1].stamp_ns <= found.stamp_ns:
                truth = waiting.pop()
                if not is_first or truth.stamp_ns == found.stamp_ns:
                    writer.write_truth(truth)
            for name, row in rows.items():
                topics.write(labels[name], row)

        yield keep
