# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Bags in SQLite: whole, split, without metadata, damaged, and with what is no bag."""

import sqlite3

import numpy as np
import pytest
from recording_samples import frame_of, stamp_of, truth_of
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.recordings.bags import messages, truth_messages
from vehicle_pf_tracker.recordings.bags.reader import Recording
from vehicle_pf_tracker.recordings.source import open_source

COUNT = 12


@pytest.fixture
def bag(tmp_path):
    """Write images and truth as rosbag2 does in SQLite; return the folder."""
    store = get_typestore(Stores.ROS2_JAZZY)
    topics = {messages.IMAGE_TOPIC: messages.IMAGE, **truth_messages.TRUTH_TYPES}
    writer = Writer(tmp_path / "bag", version=9, storage_plugin=StoragePlugin.SQLITE3)
    with writer:
        opened = {name: writer.add_connection(name, kind, typestore=store)
                  for name, kind in topics.items()}  # fmt: skip
        for index in range(COUNT):
            image = messages.image(stamp_of(index), frame_of(index))
            parts = {
                messages.IMAGE_TOPIC: image,
                **truth_messages.truth_to_messages(truth_of(index)),
            }
            for name, message in parts.items():
                data = bytes(messages.serialize(message, topics[name]))
                writer.write(opened[name], stamp_of(index), data)
    return tmp_path / "bag"


def check(recording, count=COUNT):
    images = list(recording.frames())
    assert [image.stamp_ns for image in images] == [stamp_of(index) for index in range(count)]
    assert all(np.array_equal(one.frame, frame_of(n)) for n, one in enumerate(images))
    assert [truth.stamp_ns for truth in recording.truth()] == [stamp_of(n) for n in range(count)]


def test_a_folder_is_read_without_complaint(bag):
    recording = open_source(bag)
    check(recording)
    assert recording.notices == []
    assert recording.frame_count == COUNT
    assert (recording.start_ns, recording.end_ns) == (stamp_of(0), stamp_of(COUNT - 1))


def test_a_file_alone_is_read(bag):
    (file,) = bag.glob("*.db3")
    check(open_source(file))


def test_metadata_may_be_damaged(bag):
    (bag / "metadata.yaml").write_text("")
    recording = Recording(bag)
    check(recording)
    assert "the *.db3 files beside it are used" in recording.notices[0]


def test_reading_can_begin_later(bag):
    part = list(Recording(bag).messages({messages.IMAGE_TOPIC}, start_offset=0.04 * 5))
    assert [one.stamp_ns for one in part] == [stamp_of(index) for index in range(5, COUNT)]


@pytest.mark.parametrize("name", ["a?b#c%20.db3", "10:00.db3"])
def test_files_of_any_name_are_read(bag, name):
    (file,) = bag.glob("*.db3")
    check(open_source(file.rename(bag / name)))


def test_a_message_without_data_is_said_and_the_rest_read(bag):
    (file,) = bag.glob("*.db3")
    with sqlite3.connect(file) as database:
        database.execute("UPDATE messages SET data = x'' WHERE id = 1")
        database.execute("UPDATE messages SET topic_id = 99 WHERE id = 6")
    database.close()
    recording = Recording(bag)
    assert len(list(recording.frames())) == COUNT - 1
    assert sum("was skipped" in notice for notice in recording.notices) == 2


def test_what_was_readable_of_a_damaged_file_is_used(bag):
    (file,) = bag.glob("*.db3")
    content = bytearray(file.read_bytes())
    content[len(content) // 2 : len(content) * 3 // 4] = bytes(len(content) // 4)
    file.write_bytes(content)
    try:
        recording = Recording(bag)
        assert 0 < len(list(recording.frames())) < COUNT
        assert recording.notices
    except InputError as error:
        assert str(file) in str(error)


@pytest.mark.parametrize("content", [b"no database" * 100, b"SQLite format 3\0" + bytes(99)])
def test_what_is_no_bag_names_the_command_that_converts(tmp_path, content):
    file = tmp_path / "a.db3"
    file.write_bytes(content)
    with pytest.raises(InputError, match=r"is not a bag in SQLite .* rosbags-convert --src"):
        open_source(file)


def test_a_database_of_something_else_is_refused(tmp_path):
    file = tmp_path / "a.db3"
    with sqlite3.connect(file) as database:
        database.execute("CREATE TABLE topics (id INTEGER)")
    database.close()
    with pytest.raises(InputError, match="is not a bag in SQLite"):
        open_source(file)
