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

"""A run as a recording: images, truth, estimates and annotations, written while it tracks."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TypeAlias

from vehicle_pf_tracker.core.frame import frame_size
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.evaluation.estimates import EstimateRow
from vehicle_pf_tracker.evaluation.estimates_recording import EstimateTopics
from vehicle_pf_tracker.recordings.importing import jpeg
from vehicle_pf_tracker.recordings.reader import StampedFrame
from vehicle_pf_tracker.recordings.topics import as_token
from vehicle_pf_tracker.recordings.writer import RecordingWriter

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
