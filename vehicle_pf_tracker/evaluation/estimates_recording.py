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

"""Recordings of images, truth and the estimates of trackers, for Foxglove or evo."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from vehicle_pf_tracker.core.frame import frame_size
from vehicle_pf_tracker.evaluation.estimates import EstimateRow
from vehicle_pf_tracker.evaluation.image_annotator import ImageAnnotator
from vehicle_pf_tracker.recordings import messages
from vehicle_pf_tracker.recordings.foxglove_types import IMAGE_ANNOTATIONS
from vehicle_pf_tracker.recordings.reader import Recording
from vehicle_pf_tracker.recordings.topics import (
    DIAGNOSTIC_ARRAY,
    POINT_STAMPED,
    POLYGON_STAMPED,
    TRUTH_TOPICS,
)
from vehicle_pf_tracker.recordings.writer import RecordingWriter
from vehicle_pf_tracker.trackers.estimate import Mode

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
