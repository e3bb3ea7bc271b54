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

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.evaluation.estimates import EstimateRow
from vehicle_pf_tracker.recordings import messages
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
        Estimates by node name; they go to ``/<name>/position``, ``/<name>/box`` and
        ``/<name>/mode``, as the node publishes them.
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
        for message in recording.messages(copied):
            stamp = message.log_time_ns if message.stamp_ns is None else message.stamp_ns
            writer.write_serialized(message.topic, message.type_name, stamp, message.data)
            if message.topic == recording.image_topic:
                for name, row in rows.pop(stamp, []):
                    _write_row(writer, name, row)


def _by_stamp(
    runs: Mapping[str, Sequence[EstimateRow]],
) -> dict[int, list[tuple[str, EstimateRow]]]:
    table: dict[int, list[tuple[str, EstimateRow]]] = {}
    for name, rows in runs.items():
        for row in rows:
            table.setdefault(row.stamp_ns, []).append((name, row))
    return table


def _write_row(writer: RecordingWriter, name: str, row: EstimateRow) -> None:
    stamp = row.stamp_ns
    numbers = {"x": row.x, "y": row.y, "confidence": row.confidence, "n_eff": row.n_eff}
    values = {key: repr(value) for key, value in numbers.items() if value is not None}
    mode = messages.diagnostic_array(
        stamp, name, _LEVELS.get(row.mode, messages.OK), row.mode, values
    )
    writer.write(f"/{name}/mode", DIAGNOSTIC_ARRAY, stamp, mode)
    if row.x is None or row.y is None or row.width is None or row.height is None:
        return
    point = messages.point_stamped(stamp, row.x, row.y)
    writer.write(f"/{name}/position", POINT_STAMPED, stamp, point)
    corners = Box.around((row.x, row.y), row.width, row.height).corners
    writer.write(f"/{name}/box", POLYGON_STAMPED, stamp, messages.polygon_stamped(stamp, corners))
