# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Small recordings to read, cut and damage."""

import pytest
from mcap.writer import CompressionType
from recording_samples import BareMcap, frame_of, stamp_of, truth_of

from vehicle_pf_tracker.recordings.bags.writer import RecordingWriter


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
