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

"""Small recordings to read, cut and damage."""

import pytest
from mcap.writer import CompressionType
from recording_samples import BareMcap, frame_of, stamp_of, truth_of

from vehicle_pf_tracker.recordings.writer import RecordingWriter


@pytest.fixture
def record(tmp_path):
    """Write a recording of `count` frames with truth and return its folder."""

    def record(count=10, name="bag", compression=CompressionType.LZ4, size=(24, 32)):
        folder = tmp_path / name
        with RecordingWriter(folder, compression=compression) as writer:
            for index in range(count):
                writer.write_image(stamp_of(index), frame_of(index, *size))
                writer.write_truth(truth_of(index))
        return folder

    return record


@pytest.fixture
def bare_mcap(tmp_path):
    def start(name="foreign.mcap", **options):
        return BareMcap(tmp_path / name, **options)

    return start
