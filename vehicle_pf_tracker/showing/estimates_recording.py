# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Recordings of images, truth, estimates and annotations of them, for Foxglove or evo."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from vehicle_pf_tracker.core.frame import frame_size
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.image.formats.compressed_image import jpeg
from vehicle_pf_tracker.recordings.bags import messages
from vehicle_pf_tracker.recordings.bags.reader import StampedFrame
from vehicle_pf_tracker.recordings.bags.writer import RecordingWriter
from vehicle_pf_tracker.results.estimates import EstimateRow
from vehicle_pf_tracker.showing import drawing, target_drawing
from vehicle_pf_tracker.trackers.estimate import Mode

LINE_LOOP = 2
"""Foxglove's number for points that are joined to a closed line."""
LINE_LIST = 4
"""Foxglove's number for points that are joined in pairs."""
_GROUND_OPACITY = 0.6
"""Opacity of the black behind words: they are legible on a bright road, which stays visible."""
_DASH = 4
"""Length of a dash and of a gap, in line widths: a viewer scales them with its window."""
_LETTERS = 12
"""Height of letters, in line widths: as high as a small vehicle."""


def image_annotations(name: str, row: EstimateRow, size: tuple[int, int]) -> Any:
    """Return the annotations of one estimate: its box, dashed where it is predicted, and words.

    Without a box the message is empty, for viewers that wait for one of the image's stamp.
    Positions are continuous px, as in `Box`.

    Parameters
    ----------
    name : str
        Name of the target in the words; may be empty.
    row : EstimateRow
        The estimate.
    size : (int, int)
        Width and height of the images in px, which lines and letters grow with.
    """
    box = None if row.mode == Mode.LOST else row.box
    annotations = messages.message_class(messages.IMAGE_ANNOTATIONS)
    if box is None:
        return annotations(circles=[], points=[], texts=[])
    width = drawing.line_width_of(size)
    stamp = messages.header(row.stamp_ns).stamp
    height = float(_LETTERS * width)
    colour = _colour(target_drawing.MODE_COLOURS[row.mode])
    is_dashed = row.mode == Mode.OCCLUDED
    dashes = drawing.dashes(box.corners, _DASH * width)
    ends = np.concatenate(list(dashes)) if is_dashed else box.corners
    outline = messages.message_class("foxglove_msgs/msg/PointsAnnotation")(
        timestamp=stamp,
        type=LINE_LIST if is_dashed else LINE_LOOP,
        points=[_point(*point) for point in ends],
        outline_color=colour,
        outline_colors=[],
        fill_color=_colour((0, 0, 0), 0.0),
        thickness=width,
    )
    words = messages.message_class("foxglove_msgs/msg/TextAnnotation")(
        timestamp=stamp,
        position=_point(max(box.x, 0.0), max(box.y - 2.0 * width, height)),
        text=target_drawing.estimate_words(name, row),
        font_size=height,
        text_color=colour,
        background_color=_colour((0, 0, 0), _GROUND_OPACITY),
    )
    return annotations(circles=[], points=[outline], texts=[words])


def _point(x: float, y: float) -> Any:
    return messages.message_class("foxglove_msgs/msg/Point2")(x=float(x), y=float(y))


def _colour(colour: drawing.Colour, opacity: float = 1.0) -> Any:
    red, green, blue = (value / 255 for value in colour)
    return messages.message_class("foxglove_msgs/msg/Color")(r=red, g=green, b=blue, a=opacity)


_LEVELS = {Mode.OCCLUDED.value: messages.WARN, Mode.LOST.value: messages.ERROR}
"""Levels of the modes that are not OK."""


def _write_estimate(writer: RecordingWriter, topic: str, row: EstimateRow, drawn: Any) -> None:
    """Write ``mode``, ``position`` and ``box`` under `topic` as a node does, and annotations."""
    stamp = row.stamp_ns
    numbers = {"x": row.x, "y": row.y, "confidence": row.confidence, "n_eff": row.n_eff}
    values = {key: repr(value) for key, value in numbers.items() if value is not None}
    level = _LEVELS.get(row.mode, messages.OK)
    mode = messages.diagnostic_array(stamp, topic, level, row.mode, values)
    writer.write(f"/{topic}/mode", messages.DIAGNOSTIC_ARRAY, stamp, mode)
    writer.write(f"/{topic}/annotations", messages.IMAGE_ANNOTATIONS, stamp, drawn)
    if row.position is not None and row.box is not None:
        point = messages.point_stamped(stamp, *row.position)
        writer.write(f"/{topic}/position", messages.POINT_STAMPED, stamp, point)
        polygon = messages.polygon_stamped(stamp, row.box.corners)
        writer.write(f"/{topic}/box", messages.POLYGON_STAMPED, stamp, polygon)


OnFrame: TypeAlias = Callable[[StampedFrame, Mapping[str, EstimateRow]], None]
"""Function of a frame and of the row of each target, by name."""


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
    topics = {name: node if is_single else f"{node}/{messages.as_token(name)}" for name in targets}
    is_first = True
    waiting = list(reversed(truths))
    with RecordingWriter(folder, overwrite=True) as writer:

        def keep(stamped: StampedFrame, rows: Mapping[str, EstimateRow]) -> None:
            nonlocal is_first
            if stamped.frame is None:
                return
            writer.write_compressed(stamped.stamp_ns, "jpeg", jpeg(stamped.frame))
            while waiting and waiting[-1].stamp_ns <= stamped.stamp_ns:
                truth = waiting.pop()
                if not is_first or truth.stamp_ns == stamped.stamp_ns:
                    writer.write_truth(truth)
            is_first = False
            size = frame_size(stamped.frame)
            for name, row in rows.items():
                drawn = image_annotations("" if is_single else name, row, size)
                _write_estimate(writer, topics[name], row, drawn)

        yield keep
