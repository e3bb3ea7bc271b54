# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Reading back: pictures, truth, messages, topics, time, memory."""

import shutil
import tracemalloc

import cv2
import numpy as np
import pytest
import yaml
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from mcap.writer import CompressionType, IndexType
from recording_samples import PERIOD_NS, frame_of, stamp_of, truth_of
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.recordings.bags import mcap_blocks, messages
from vehicle_pf_tracker.recordings.bags.reader import Recording
from vehicle_pf_tracker.recordings.bags.writer import RecordingWriter


def stamps(recording, **span):
    return [found.stamp_ns for found in recording.messages({recording.image_topic}, **span)]


@pytest.mark.parametrize("compression", CompressionType)
def test_raw_frames_come_back_unchanged(record, compression):
    recording = Recording(record(10, compression=compression))
    frames = list(recording.frames())
    assert recording.frame_count == len(frames) == 10
    assert recording.image_topic == messages.IMAGE_TOPIC
    assert recording.image_type == messages.IMAGE
    for index, found in enumerate(frames):
        assert found.stamp_ns == stamp_of(index)
        assert np.array_equal(found.frame, frame_of(index))
    assert recording.notices == []


@pytest.mark.parametrize("compression", CompressionType)
def test_compressed_frames_come_back(tmp_path, compression):
    with RecordingWriter(tmp_path / "bag", compression=compression) as writer:
        for index in range(5):
            coded = cv2.imencode(".png", frame_of(index)[..., ::-1])[1].tobytes()
            writer.write_compressed(stamp_of(index), "png", coded)
    recording = Recording(tmp_path / "bag")
    assert recording.image_type == messages.COMPRESSED_IMAGE
    for index, found in enumerate(recording.frames()):
        assert np.array_equal(found.frame, frame_of(index))
    assert stamps(recording) == [stamp_of(index) for index in range(5)]


def test_a_compressed_frame_that_claims_gigabytes_is_left_out_and_told(tmp_path):
    with RecordingWriter(tmp_path / "bag") as writer:
        for index in range(3):
            coded = cv2.imencode(".png", frame_of(index)[..., ::-1])[1].tobytes()
            if index == 1:
                size = (30_000).to_bytes(4, "big")
                coded = coded[:16] + size + size + coded[24:]
            writer.write_compressed(stamp_of(index), "png", coded)
    recording = Recording(tmp_path / "bag")
    frames = [found.frame for found in recording.frames()]
    assert [frame is None for frame in frames] == [False, True, False]
    assert "claims 30000x30000 px" in " ".join(recording.notices)


def test_raw_frames_are_views_that_cannot_be_written_to(record):
    frame = next(Recording(record(1)).frames()).frame
    assert not frame.flags.writeable
    assert not frame.flags.owndata


def test_a_single_frame_is_a_recording(record):
    recording = Recording(record(1))
    assert recording.end_ns - recording.start_ns == 0
    assert stamps(recording) == [stamp_of(0)]
    assert len(recording.truth()) == 1


def test_truth_has_the_stamps_of_the_images_and_its_numbers(record):
    recording = Recording(record(9))
    truth = recording.truth()
    assert [t.stamp_ns for t in truth] == stamps(recording)
    for index, found in enumerate(truth):
        expected = truth_of(index)
        assert found.box.centre == pytest.approx(expected.box.centre, abs=1e-12)
        assert found.box.width == pytest.approx(expected.box.width, abs=1e-5)
        assert found.box.height == pytest.approx(expected.box.height, abs=1e-5)
        assert found.occlusion is expected.occlusion
        assert found.visible_fraction == expected.visible_fraction
    assert recording.first_truth() == truth[0]


def test_no_truth_topics_are_no_truth(tmp_path):
    with RecordingWriter(tmp_path / "bag") as writer:
        writer.write_image(stamp_of(0), frame_of(0))
    assert Recording(tmp_path / "bag").truth() == ()
    assert Recording(tmp_path / "bag").first_truth() is None


def test_a_bare_file_reads_like_its_folder(record):
    folder = record(4)
    (file,) = folder.glob("*.mcap")
    assert stamps(Recording(file)) == stamps(Recording(str(folder)))


def test_messages_keep_their_bytes_and_the_order_of_their_log_times(bare_mcap):
    bag = bare_mcap(chunk_size=3000)
    bag.images((3, 0, 4, 1, 2, 9, 8, 7, 6, 5))
    recording = Recording(bag.close())
    found = list(recording.messages())
    assert [m.log_time_ns for m in found] == [stamp_of(index) for index in range(10)]
    assert [m.stamp_ns for m in found] == [stamp_of(index) for index in range(10)]
    assert stamps(recording) == [stamp_of(index) for index in range(10)]
    expected = messages.image(stamp_of(0), frame_of(0)).data.tobytes()
    assert isinstance(found[0].data, bytes)
    assert found[0].data.endswith(expected)


def test_stamps_are_the_headers_not_the_log_times(bare_mcap):
    bag = bare_mcap()
    camera = bag.channel(messages.IMAGE_TOPIC, messages.IMAGE)
    bag.image(camera, 5, log_time=77)
    recording = Recording(bag.close())
    assert stamps(recording) == [stamp_of(5)]
    assert next(recording.messages()).log_time_ns == 77


def test_big_endian_messages_are_read(bare_mcap):
    bag = bare_mcap()
    camera = bag.channel(messages.IMAGE_TOPIC, messages.IMAGE)
    message = messages.image(stamp_of(2), frame_of(2))
    store = get_typestore(Stores.ROS2_JAZZY)
    data = store.serialize_cdr(message, messages.IMAGE, little_endian=False)
    bag.raw(camera, 1, bytes(data))
    recording = Recording(bag.close())
    assert next(recording.messages()).stamp_ns == stamp_of(2)
    assert np.array_equal(next(recording.frames()).frame, frame_of(2))


def test_messages_of_unknown_types_are_listed(bare_mcap):
    bag = bare_mcap()
    bag.image(bag.channel(messages.IMAGE_TOPIC, messages.IMAGE), 0)
    bag.raw(bag.channel("/bare", "strange_msgs/msg/Bare", schema="int32 x\n"), 2, b"\0\1\0\0abcd")
    bag.raw(bag.channel("/nothing_said", None), 3, b"?")
    bag.raw(bag.channel("/json", "strange_msgs/msg/Json", "json", "{}"), 4, b"{}")
    found = {m.topic: m for m in Recording(bag.close()).messages()}
    assert found["/bare"].stamp_ns is None
    assert found["/bare"].type_name == "strange_msgs/msg/Bare"
    assert (found["/nothing_said"].type_name, found["/nothing_said"].stamp_ns) == ("", None)
    assert found["/json"].data == b"{}"


def test_several_image_topics_need_a_choice(bare_mcap):
    bag = bare_mcap()
    for topic, index in (("/left", 1), ("/right", 2)):
        bag.image(bag.channel(topic, messages.IMAGE), index)
    bag.channel("/never_published", messages.IMAGE)
    bag.add(
        bag.channel("/point", messages.POINT_STAMPED),
        5,
        messages.point_stamped(5, 1, 2),
        messages.POINT_STAMPED,
    )
    path = bag.close()
    with pytest.raises(InputError, match=r"--topic: /left, /right$"):
        Recording(path)
    assert stamps(Recording(path, "/right")) == [stamp_of(2)]
    with pytest.raises(InputError, match=r"no topic /middle; .*/left, /right"):
        Recording(path, "/middle")
    with pytest.raises(InputError, match="PointStamped, no images"):
        Recording(path, "/point")
    with pytest.raises(InputError, match=r"/never_published .*no messages"):
        Recording(path, "/never_published")


def test_one_topic_on_two_channels_is_one_topic(bare_mcap):
    bag = bare_mcap()
    for index in range(4):
        bag.image(bag.channel("/camera", messages.IMAGE), index)
    recording = Recording(bag.close())
    assert recording.frame_count == 4
    assert len(stamps(recording)) == 4


def test_no_image_topic_names_what_there_is(bare_mcap):
    bag = bare_mcap()
    point = messages.point_stamped(5, 1, 2)
    bag.add(bag.channel("/gps", messages.POINT_STAMPED), 5, point, messages.POINT_STAMPED)
    with pytest.raises(InputError, match=r"no images; its topics are: /gps"):
        Recording(bag.close())


def test_what_is_no_recording_is_said(tmp_path):
    with pytest.raises(InputError, match="there is no recording"):
        Recording(tmp_path / "nothing")
    with pytest.raises(InputError, match="holds no recording"):
        Recording(tmp_path)
    for content in (b"", b"\x89MC", b"PK\x03\x04 a zip file of some length, surely no recording"):
        (tmp_path / "file.mcap").write_bytes(content)
        with pytest.raises(InputError, match="not an MCAP file"):
            Recording(tmp_path / "file.mcap")


def split(record, tmp_path, parts=3):
    """Record in several files, as `ros2 bag record --max-bag-duration` does."""
    folder = tmp_path / "split"
    folder.mkdir()
    names = []
    for part in range(parts):
        with RecordingWriter(tmp_path / f"part{part}") as writer:
            for index in range(4 * part, 4 * part + 4):
                writer.write_image(stamp_of(index), frame_of(index))
                writer.write_truth(truth_of(index))
        (file,) = (tmp_path / f"part{part}").glob("*.mcap")
        names.append(f"bag_{part + 8}.mcap")
        shutil.move(file, folder / names[-1])
    bag = {"storage_identifier": "mcap", "relative_file_paths": names, "version": 9}
    text = yaml.safe_dump({"rosbag2_bagfile_information": bag})
    (folder / "metadata.yaml").write_text(text)
    return folder


def test_a_split_recording_is_one(record, tmp_path):
    recording = Recording(split(record, tmp_path))
    assert recording.frame_count == 12
    assert stamps(recording) == [stamp_of(index) for index in range(12)]
    assert len(recording.truth()) == 12
    assert recording.end_ns - recording.start_ns == 11 * PERIOD_NS


def test_a_folder_without_usable_metadata_is_read_by_its_files(record, tmp_path):
    folder = split(record, tmp_path)
    for text in ("rosbag2_bagfile_information: [", "- 1", "rosbag2_bagfile_information: 3"):
        (folder / "metadata.yaml").write_text(text)
        recording = Recording(folder)
        assert "damaged" in recording.notices[0]
    (folder / "metadata.yaml").unlink()
    recording = Recording(folder)
    assert "metadata.yaml is missing" in recording.notices[0]
    # bag_10 comes after bag_9, not before bag_8.
    assert [index.path.name for index in recording.files] == [
        "bag_8.mcap",
        "bag_9.mcap",
        "bag_10.mcap",
    ]
    assert stamps(recording) == [stamp_of(index) for index in range(12)]


def test_a_lost_part_of_a_split_recording_is_said(record, tmp_path):
    folder = split(record, tmp_path)
    (folder / "bag_9.mcap").unlink()
    recording = Recording(folder)
    assert "bag_9.mcap" in recording.notices[0]
    assert stamps(recording) == [stamp_of(index) for index in (0, 1, 2, 3, 8, 9, 10, 11)]


def test_a_recording_that_lacks_its_file_says_so(record):
    folder = record(1)
    content = yaml.safe_load((folder / "metadata.yaml").read_text())
    content["rosbag2_bagfile_information"]["relative_file_paths"] = ["gone.mcap"]
    (folder / "metadata.yaml").write_text(yaml.safe_dump(content))
    with pytest.raises(InputError, match=r"lacks its file gone\.mcap"):
        Recording(folder)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=40)
@given(cut=st.integers(0, 24))
def test_two_spans_that_meet_share_no_frame_and_lose_none(record, tmp_path, cut):
    folder = tmp_path / "bag"
    if not folder.exists():
        record(12)
    recording = Recording(folder)
    seconds = cut * PERIOD_NS / 2 / 1e9
    before = stamps(recording, duration=seconds)
    after = stamps(recording, start_offset=seconds)
    assert before + after == [stamp_of(index) for index in range(12)]
    assert len(before) == min((cut + 1) // 2, 12)


def test_seeking_reads_only_what_is_wanted(record, monkeypatch):
    recording = Recording(record(60, compression=CompressionType.NONE, size=(200, 200)))
    total = 60 * 200 * 200 * 3
    read = []

    def counted(path, offset, length):
        read.append(length)
        return original(path, offset, length)

    original = mcap_blocks.read_span
    monkeypatch.setattr(mcap_blocks, "read_span", counted)
    assert len(stamps(recording)) == 60
    assert sum(read) > total
    read.clear()
    assert stamps(recording, start_offset=56 * PERIOD_NS / 1e9) == [
        stamp_of(index) for index in range(56, 60)
    ]
    assert 0 < sum(read) < total / 4
    read.clear()
    assert recording.first_truth() is not None
    assert sum(read) < total / 2


@pytest.mark.parametrize("chunked", [True, False])
def test_reading_holds_a_small_part_in_memory(bare_mcap, chunked):
    """30 MB, with chunks (1 MB each) and as the `fastwrite` preset of rosbag2 leaves it."""
    bag = bare_mcap(use_chunking=chunked, index_types=IndexType.ALL)
    camera = bag.channel(messages.IMAGE_TOPIC, messages.IMAGE)
    frame = frame_of(0, 320, 320)
    for index in range(100):
        message = messages.image(stamp_of(index), frame)
        bag.add(camera, stamp_of(index), message, messages.IMAGE)
    path = bag.close()
    assert path.stat().st_size > 30e6
    tracemalloc.start()
    try:
        count = sum(1 for _ in Recording(path).frames())
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert count == 100
    assert peak < 8e6


@pytest.mark.parametrize(
    "options",
    [
        {"index_types": IndexType.NONE},
        {"repeat_channels": False},
        {"repeat_schemas": False},
        {"use_statistics": False},
        {"use_chunking": False},
        {"use_chunking": False, "use_statistics": False, "repeat_channels": False},
        {"index_types": IndexType.CHUNK, "compression": CompressionType.ZSTD},
    ],
)
def test_whole_files_without_a_full_index_are_read_without_complaint(bare_mcap, options):
    bag = bare_mcap(chunk_size=4000, **options)
    bag.images(range(6))
    recording = Recording(bag.close())
    assert recording.notices == []
    assert recording.frame_count == 6
    assert stamps(recording) == [stamp_of(index) for index in range(6)]


@pytest.mark.parametrize("version", [8, 9])
@pytest.mark.parametrize(
    ("storage", "mode", "said"),
    [
        ("MCAP", "NONE", ""),
        ("MCAP", "STORAGE", ""),
        ("MCAP", "FILE", "is compressed by file; convert it: rosbags-convert --src"),
        ("MCAP", "MESSAGE", "is compressed by message; convert it: rosbags-convert --src"),
        ("SQLITE3", "NONE", ""),
        ("SQLITE3", "FILE", "is compressed by file; convert it: rosbags-convert --src"),
    ],
)
def test_recordings_of_another_writer_of_rosbag2(tmp_path, version, storage, mode, said):
    store = get_typestore(Stores.ROS2_JAZZY)
    image, header, time = (
        store.types[name]
        for name in (messages.IMAGE, "std_msgs/msg/Header", "builtin_interfaces/msg/Time")
    )
    writer = Writer(tmp_path / "bag", version=version, storage_plugin=StoragePlugin[storage])
    if mode != "NONE":
        writer.set_compression(CompressionMode[mode], CompressionFormat.ZSTD)
    with writer:
        camera = writer.add_connection("/camera", messages.IMAGE, typestore=store)
        for index in range(3):
            stamp = time(*divmod(stamp_of(index), 10**9))
            pixels = frame_of(index).ravel()
            message = image(header(stamp, "camera"), 24, 32, "rgb8", 0, 96, pixels)
            data = store.serialize_cdr(message, messages.IMAGE)
            writer.write(camera, stamp_of(index), data)
    if said:
        with pytest.raises(InputError, match=said):
            Recording(tmp_path / "bag")
        return
    found = Recording(tmp_path / "bag")
    assert stamps(found) == [stamp_of(index) for index in range(3)]
    assert np.array_equal(next(iter(found.frames())).frame, frame_of(0))
    assert found.notices == []
