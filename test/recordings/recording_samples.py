# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Pictures, truth and foreign MCAP files for the tests of recordings."""

from pathlib import Path

import numpy as np
from mcap.writer import CompressionType, Writer

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.recordings.bags import messages
from vehicle_pf_tracker.recordings.bags.messages import definition, serialize

PERIOD_NS = 40_000_000


def stamp_of(index):
    return 1_000_000_000 + index * PERIOD_NS


def frame_of(index, height=24, width=32):
    """Noise, so that nothing compresses it away; another one for each index."""
    return np.random.default_rng(index).integers(0, 256, (height, width, 3), np.uint8)


def truth_of(index):
    box = Box(1.25 + index, 2.1, 7.3, 4.7)
    return Truth(stamp_of(index), box, Occlusion(index % 3), 1.0 - 0.01 * index)


class BareMcap:
    """An MCAP file with the foibles of foreign recorders."""

    def __init__(self, path: Path, **options):
        self.path = path
        self.stream = path.open("wb")
        self.writer = Writer(self.stream, **{"compression": CompressionType.NONE, **options})
        self.writer.start(profile="ros2")

    def channel(self, topic, type_name, encoding="cdr", schema=None):
        schema_id = 0
        if type_name:
            text = definition(type_name) if schema is None else schema
            schema_id = self.writer.register_schema(type_name, "ros2msg", text.encode())
        return self.writer.register_channel(topic, encoding, schema_id)

    def image(self, channel, index, log_time=None, **shape):
        message = messages.image(stamp_of(index), frame_of(index, **shape))
        self.add(
            channel, stamp_of(index) if log_time is None else log_time, message, messages.IMAGE
        )

    def images(self, indices, **shape):
        camera = self.channel(messages.IMAGE_TOPIC, messages.IMAGE)
        for index in indices:
            self.image(camera, index, **shape)

    def add(self, channel, log_time, message, type_name):
        self.raw(channel, log_time, bytes(serialize(message, type_name)))

    def raw(self, channel, log_time, data):
        self.writer.add_message(channel, log_time, data, log_time)

    def close(self):
        self.writer.finish()
        self.stream.close()
        return self.path
