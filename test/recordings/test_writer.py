# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""What other readers, rosbag2's rules and a failing program make of our recordings."""

from pathlib import Path

import numpy as np
import pytest
import yaml
from mcap.reader import make_reader
from mcap.writer import CompressionType
from recording_samples import frame_of, stamp_of, truth_of
from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import Reader

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.recordings.bags import messages, truth_messages
from vehicle_pf_tracker.recordings.bags import writer as writing
from vehicle_pf_tracker.recordings.bags.reader import Recording
from vehicle_pf_tracker.recordings.bags.writer import RecordingWriter


def only_mcap(folder):
    (path,) = folder.glob("*.mcap")
    return path


def information(folder):
    return yaml.safe_load((folder / "metadata.yaml").read_text())["rosbag2_bagfile_information"]


def test_messages_of_a_topic_are_numbered(record):
    with only_mcap(record(4)).open("rb") as stream:
        found = [(c.topic, m.sequence) for _, c, m in make_reader(stream).iter_messages()]
    for topic in (messages.IMAGE_TOPIC, *truth_messages.TRUTH_TOPICS):
        assert [number for name, number in found if name == topic] == [0, 1, 2, 3]


@pytest.mark.parametrize("compression", CompressionType)
def test_other_readers_find_every_message(record, compression):
    folder = record(7, compression=compression)
    with Reader(folder) as reader:
        assert sum(1 for _ in reader.messages()) == 28
    with AnyReader([folder]) as reader:
        assert {c.topic: c.msgcount for c in reader.connections} == dict.fromkeys(
            [messages.IMAGE_TOPIC, *truth_messages.TRUTH_TOPICS], 7
        )
        connection, _, data = next(reader.messages())
        image = reader.deserialize(data, connection.msgtype)
        assert np.array_equal(image.data.reshape(24, 32, 3), frame_of(0))
    with only_mcap(folder).open("rb") as stream:
        assert sum(1 for _ in make_reader(stream, validate_crcs=True).iter_messages()) == 28


def test_metadata_has_what_rosbag2_asks_for(record):
    folder = record(5)
    bag = information(folder)
    assert bag["version"] == 9
    assert bag["storage_identifier"] == "mcap"
    assert bag["relative_file_paths"] == [only_mcap(folder).name]
    assert bag["starting_time"] == {"nanoseconds_since_epoch": stamp_of(0)}
    assert bag["duration"] == {"nanoseconds": stamp_of(4) - stamp_of(0)}
    assert bag["message_count"] == 20
    assert bag["files"][0]["message_count"] == 20
    assert {"compression_format", "compression_mode", "custom_data", "ros_distro"} <= bag.keys()


def test_metadata_equals_what_the_channels_say(record):
    folder = record(2)
    listed = {
        topic["topic_metadata"]["name"]: topic["topic_metadata"]
        for topic in information(folder)["topics_with_message_count"]
    }
    with only_mcap(folder).open("rb") as stream:
        reader = make_reader(stream)
        summary = reader.get_summary()
        inside = next(reader.iter_metadata())
    assert len(summary.channels) == 4
    for channel in summary.channels.values():
        topic = listed[channel.topic]
        profiles = yaml.safe_load(channel.metadata["offered_qos_profiles"])
        assert profiles == topic["offered_qos_profiles"]
        assert profiles[0]["reliability"] == "reliable"
        assert channel.metadata["topic_type_hash"] == topic["type_description_hash"]
        assert summary.schemas[channel.schema_id].name == topic["type"]
        assert summary.schemas[channel.schema_id].encoding == "ros2msg"
    assert inside.name == "rosbag2"
    assert yaml.safe_load(inside.metadata["serialized_metadata"]) == information(folder)


def test_type_hash_is_the_one_of_ros(record):
    """The hash of sensor_msgs/msg/Image in ROS 2 Jazzy, from its installed Image.json."""
    image = information(record(1))["topics_with_message_count"][0]["topic_metadata"]
    digest = "d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47"
    assert image["type_description_hash"] == f"RIHS01_{digest}"


def test_schema_holds_the_types_it_is_made_of(record):
    with only_mcap(record(1)).open("rb") as stream:
        schemas = make_reader(stream).get_summary().schemas.values()
    text = next(s.data.decode() for s in schemas if s.name == messages.IMAGE)
    assert "MSG: std_msgs/Header" in text
    assert "MSG: builtin_interfaces/Time" in text


def test_any_message_can_be_added(tmp_path):
    folder = tmp_path / "out"
    with RecordingWriter(folder) as writer:
        writer.write_image(stamp_of(0), frame_of(0))
        point = messages.point_stamped(stamp_of(0), 3.5, 4.25)
        writer.write("/apf_tracker/position", messages.POINT_STAMPED, stamp_of(0), point)
        with pytest.raises(InputError, match="carries"):
            writer.write("/apf_tracker/position", messages.IMAGE, 0, messages.image(0, frame_of(0)))
        with pytest.raises(InputError, match="no_such"):
            writer.write("/x", "no_such/msg/Type", 0, point)
    found = list(Recording(folder).messages({"/apf_tracker/position"}))
    assert [(m.type_name, m.stamp_ns) for m in found] == [(messages.POINT_STAMPED, stamp_of(0))]


def test_an_interrupted_block_leaves_nothing(tmp_path):
    with pytest.raises(KeyboardInterrupt), RecordingWriter(tmp_path / "out") as writer:
        writer.write_truth(truth_of(0))
        raise KeyboardInterrupt
    assert list(tmp_path.iterdir()) == []


def test_the_folder_is_not_there_before_it_is_whole(tmp_path):
    with RecordingWriter(tmp_path / "deep" / "out") as writer:
        writer.write_image(stamp_of(0), frame_of(0))
        assert not (tmp_path / "deep" / "out").exists()
    assert Recording(tmp_path / "deep" / "out").frame_count == 1
    assert [path.name for path in (tmp_path / "deep").iterdir()] == ["out"]


def test_an_existing_recording_is_replaced_only_on_demand(record):
    folder = record(3)
    with pytest.raises(InputError, match="not empty"):
        RecordingWriter(folder)
    with RecordingWriter(folder, overwrite=True) as writer:
        writer.write_image(stamp_of(0), frame_of(0))
        assert Recording(folder).frame_count == 3
    assert Recording(folder).frame_count == 1


def test_a_recording_is_still_there_when_its_replacement_is_ended(tmp_path, monkeypatch):
    folder = tmp_path / "bag"
    with RecordingWriter(folder) as writer:
        writer.write_truth(truth_of(0))
    before = (folder / "bag_0.mcap").read_bytes()
    rename = Path.rename

    def ended(path, target):
        if path.suffix == ".partial":
            raise KeyboardInterrupt
        return rename(path, target)

    monkeypatch.setattr(Path, "rename", ended)
    with pytest.raises(KeyboardInterrupt), RecordingWriter(folder, overwrite=True) as writer:
        writer.write_image(5, np.zeros((4, 6, 3), np.uint8))
    assert [path.name for path in tmp_path.iterdir()] == ["bag"]
    assert (folder / "bag_0.mcap").read_bytes() == before


def test_a_recording_that_cannot_be_begun_leaves_nothing(tmp_path, monkeypatch):
    def ended(*_arguments, **_options):
        raise KeyboardInterrupt

    monkeypatch.setattr(writing.Writer, "start", ended)
    with pytest.raises(KeyboardInterrupt):
        RecordingWriter(tmp_path / "bag")
    assert list(tmp_path.iterdir()) == []


def test_overwrite_never_replaces_anything_else(tmp_path):
    (tmp_path / "holiday.jpg").write_bytes(b"dear to somebody")
    with pytest.raises(InputError, match="more than a recording"):
        RecordingWriter(tmp_path, overwrite=True)
    with pytest.raises(InputError, match="is a file"):
        RecordingWriter(tmp_path / "holiday.jpg", overwrite=True)
    assert (tmp_path / "holiday.jpg").read_bytes() == b"dear to somebody"


def test_an_empty_folder_may_be_used(tmp_path):
    (tmp_path / "out").mkdir()
    with RecordingWriter(tmp_path / "out") as writer:
        writer.write_image(stamp_of(0), frame_of(0))
    assert Recording(tmp_path / "out").frame_count == 1


def test_an_unwritable_folder_is_an_input_error(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="cannot write"):
        RecordingWriter(tmp_path / "file" / "out")


def test_a_full_disk_is_an_input_error(tmp_path, monkeypatch):
    def full(*_args, **_kwargs):
        raise OSError(28, "No space left on device")

    with (
        pytest.raises(InputError, match="No space left"),
        RecordingWriter(tmp_path / "out") as writer,
    ):
        monkeypatch.setattr("mcap.writer.Writer.add_message", full)
        writer.write_image(stamp_of(0), frame_of(0))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("frame", [np.zeros((4, 4), np.uint8), np.zeros((4, 4, 3), np.float32)])
def test_only_frames_are_written(tmp_path, frame):
    with pytest.raises(InputError, match="frame"), RecordingWriter(tmp_path / "out") as writer:
        writer.write_image(0, frame)
