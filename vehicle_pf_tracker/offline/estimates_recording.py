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

"""Recordings of images, truth, estimates and annotations of them, for Foxglove or evo."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from vehicle_pf_tracker.core.box import Box, Position
from vehicle_pf_tracker.core.frame import frame_size
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.image.compressed_image import jpeg
from vehicle_pf_tracker.offline.drawing import (
    COLOURS,
    NEUTRAL,
    Colour,
    dashes,
    estimate_words,
    line_width_of,
)
from vehicle_pf_tracker.offline.estimates import EstimateRow
from vehicle_pf_tracker.recordings import messages
from vehicle_pf_tracker.recordings.messages import (
    DIAGNOSTIC_ARRAY,
    IMAGE_ANNOTATIONS,
    POINT_STAMPED,
    POLYGON_STAMPED,
    as_token,
    message_class,
)
from vehicle_pf_tracker.recordings.reader import StampedFrame
from vehicle_pf_tracker.recordings.writer import RecordingWriter
from vehicle_pf_tracker.trackers.estimate import Mode

LINE_LOOP, LINE_STRIP, LINE_LIST = 2, 3, 4
"""Ways to join points: to a closed line, to an open one, and in pairs."""

_GROUND_OPACITY = 0.6
"""Opacity of the black behind words: they are legible on a bright road, which stays visible."""
_PATH_LENGTH = 60
"""Positions in a path. Every message repeats them: 60 cost 1 kB, and show two seconds of video."""
_DASH = 4
"""Length of a dash and of a gap, in line widths."""
_LETTERS = 12
"""Height of letters, in line widths."""


class ImageAnnotator:
    """Makes the annotations of one track; keeps its path.

    Every image gets words with the mode, so that a viewer which waits for annotations of the same
    stamp shows images without an estimate too. Positions are continuous px, as in `Box`.

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
        self._path: deque[Position] = deque(maxlen=_PATH_LENGTH)

    def annotate(self, row: EstimateRow) -> Any:
        """Continue the path with `row`, and return the message for its image."""
        box = None if row.mode == Mode.LOST else row.box
        if box is None:
            self._path.clear()
        else:
            self._path.append(box.centre)
        stamp = messages.header(row.stamp_ns).stamp
        lines = () if box is None else self._lines(row, box)
        return message_class(IMAGE_ANNOTATIONS)(
            circles=[],
            points=[self._line(stamp, row, kind, points) for kind, points in lines],
            texts=[self._words(stamp, row, box)],
        )

    def _lines(self, row: EstimateRow, box: Box) -> Iterator[tuple[int, Sequence[Position]]]:
        """Yield the way to join the points of each line, and the points."""
        if row.mode == Mode.OCCLUDED:
            ends = np.concatenate(list(dashes(box.corners, _DASH * self._width)))
            yield LINE_LIST, ends.tolist()
        else:
            yield LINE_LOOP, box.corners
        if len(self._path) > 1:
            yield LINE_STRIP, list(self._path)

    def _line(self, stamp: Any, row: EstimateRow, kind: int, points: Sequence[Position]) -> Any:
        return message_class("foxglove_msgs/msg/PointsAnnotation")(
            timestamp=stamp,
            type=kind,
            points=[_point(*point) for point in points],
            outline_color=_colour(COLOURS[row.mode]),
            outline_colors=[],
            fill_color=_colour((0, 0, 0), 0.0),
            thickness=self._width,
        )

    def _words(self, stamp: Any, row: EstimateRow, box: Box | None) -> Any:
        height = float(_LETTERS * self._width)
        if box is None:
            corner = (height / 2, 1.5 * height * (self._position + 1))
        else:
            corner = (max(box.x, 0.0), max(box.y - 2.0 * self._width, height))
        return message_class("foxglove_msgs/msg/TextAnnotation")(
            timestamp=stamp,
            position=_point(*corner),
            text=estimate_words(self._name, row),
            font_size=height,
            text_color=_colour(COLOURS.get(row.mode, NEUTRAL)),
            background_color=_colour((0, 0, 0), _GROUND_OPACITY),
        )


def _point(x: float, y: float) -> Any:
    return message_class("foxglove_msgs/msg/Point2")(x=float(x), y=float(y))


def _colour(colour: Colour, opacity: float = 1.0) -> Any:
    red, green, blue = (value / 255 for value in colour)
    return message_class("foxglove_msgs/msg/Color")(r=red, g=green, b=blue, a=opacity)


_LEVELS = {Mode.OCCLUDED.value: messages.WARN, Mode.LOST.value: messages.ERROR}
"""Levels of the modes that are not OK."""


def _write_estimate(
    writer: RecordingWriter, topic: str, row: EstimateRow, annotator: ImageAnnotator
) -> None:
    """Write ``mode``, ``position`` and ``box`` under `topic` as a node does, and annotations."""
    stamp = row.stamp_ns
    numbers = {"x": row.x, "y": row.y, "confidence": row.confidence, "n_eff": row.n_eff}
    values = {key: repr(value) for key, value in numbers.items() if value is not None}
    level = _LEVELS.get(row.mode, messages.OK)
    mode = messages.diagnostic_array(stamp, topic, level, row.mode, values)
    writer.write(f"/{topic}/mode", DIAGNOSTIC_ARRAY, stamp, mode)
    writer.write(f"/{topic}/annotations", IMAGE_ANNOTATIONS, stamp, annotator.annotate(row))
    if row.position is not None and row.box is not None:
        point = messages.point_stamped(stamp, *row.position)
        writer.write(f"/{topic}/position", POINT_STAMPED, stamp, point)
        polygon = messages.polygon_stamped(stamp, row.box.corners)
        writer.write(f"/{topic}/box", POLYGON_STAMPED, stamp, polygon)


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
    is_single = len(targets) == 1
    topics = {name: node if is_single else f"{node}/{as_token(name)}" for name in targets}
    annotators: dict[str, ImageAnnotator] = {}
    waiting = list(reversed(truths))
    with RecordingWriter(folder, overwrite=True) as writer:

        def keep(found: StampedFrame, rows: Mapping[str, EstimateRow]) -> None:
            if found.frame is None:
                return
            is_first, size = not annotators, frame_size(found.frame)
            for position, name in enumerate(targets if is_first else ()):
                annotators[name] = ImageAnnotator("" if is_single else name, size, position)
            writer.write_compressed(found.stamp_ns, "jpeg", jpeg(found.frame))
            while waiting and waiting[-1].stamp_ns <= found.stamp_ns:
                truth = waiting.pop()
                if not is_first or truth.stamp_ns == found.stamp_ns:
                    writer.write_truth(truth)
            for name, row in rows.items():
                _write_estimate(writer, topics[name], row, annotators[name])

        yield keep
