# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Cut and damaged recordings: everything readable is used, and the loss is said."""

import struct

import pytest
import zstandard
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from mcap.writer import CompressionType, IndexType
from recording_samples import BareMcap, frame_of, stamp_of, truth_of

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.recordings.bags import messages
from vehicle_pf_tracker.recordings.bags.mcap_index import MAGIC, read_index
from vehicle_pf_tracker.recordings.bags.reader import Recording

COUNT = 12
ZEROS = zstandard.ZstdCompressor().compress(bytes(250 * 10**6))
COMPRESSIONS = list(CompressionType)
LAYOUTS = [
    *({"compression": compression, "chunk_size": 8000} for compression in COMPRESSIONS),
    {"compression": CompressionType.LZ4, "chunk_size": 10**6},
    {"compression": CompressionType.NONE, "chunk_size": 10**6},
    {"use_chunking": False},
    {"index_types": IndexType.NONE, "chunk_size": 8000},
]


def stamps(recording):
    return [found.stamp_ns for found in recording.frames()]


class Wholes(list):
    """Files as bytes; does not print them."""

    __repr__ = object.__repr__


@pytest.fixture(scope="module")
def wholes(tmp_path_factory):
    """Whole files of 12 images in every layout, as bytes."""
    files = Wholes()
    for number, layout in enumerate(LAYOUTS):
        bag = BareMcap(tmp_path_factory.mktemp("whole") / f"{number}.mcap", **layout)
        bag.images(range(COUNT))
        files.append(bag.close().read_bytes())
    return files


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=150)
@given(layout=st.integers(0, len(LAYOUTS) - 1), share=st.floats(0, 1))
def test_a_file_cut_anywhere_gives_the_frames_before_the_cut(wholes, tmp_path, layout, share):
    whole = wholes[layout]
    path = tmp_path / "cut.mcap"
    path.write_bytes(whole[: int(share * (len(whole) - 1))])
    try:
        recording = Recording(path)
    except InputError as error:
        assert "not an MCAP" in str(error) or "nothing in it can be used" in str(error)
        return
    found = list(recording.frames())
    assert [f.stamp_ns for f in found] == [stamp_of(index) for index in range(len(found))]
    assert all((f.frame == frame_of(index)).all() for index, f in enumerate(found))
    assert recording.frame_count == len(found)
    assert recording.notices == [
        f"recording {path} is truncated after frame {len(found)}; what was readable is used"
    ]


@pytest.mark.parametrize(("layout", "left"), [(0, 8), (5, 11), (6, 8)])
def test_no_whole_chunk_or_message_before_the_cut_is_lost(wholes, tmp_path, layout, left):
    """Cut in the middle of the last image, in chunks of four or without."""
    whole = wholes[layout]
    last = whole.index(frame_of(COUNT - 1).tobytes())
    path = tmp_path / "cut.mcap"
    path.write_bytes(whole[: last + 1000])
    assert len(stamps(Recording(path))) == left


@pytest.mark.parametrize("lost", [1, 8, 9, 36, 37, 100])
@pytest.mark.parametrize("layout", range(len(LAYOUTS)))
def test_a_lost_end_alone_loses_no_frame(wholes, tmp_path, layout, lost):
    path = tmp_path / "cut.mcap"
    path.write_bytes(wholes[layout][:-lost])
    recording = Recording(path)
    assert len(stamps(recording)) == COUNT
    assert f"truncated after frame {COUNT}" in recording.notices[0]


def test_a_tail_of_zeros_is_a_cut(wholes, tmp_path):
    """A file system leaves such a tail after a power failure."""
    path = tmp_path / "cut.mcap"
    path.write_bytes(wholes[0][: len(wholes[0]) // 2] + bytes(5000))
    recording = Recording(path)
    assert 0 < len(stamps(recording)) < COUNT
    assert any("truncated" in notice for notice in recording.notices)


@pytest.mark.parametrize("layout", [0, 1, 2])
def test_a_damaged_chunk_is_skipped_and_said(wholes, tmp_path, layout):
    damaged = bytearray(wholes[layout])
    start = len(damaged) // 2
    damaged[start : start + 50] = bytes(50)
    path = tmp_path / "damaged.mcap"
    path.write_bytes(damaged)
    recording = Recording(path)
    assert COUNT - 4 <= len(stamps(recording)) < COUNT
    assert len(stamps(recording)) < COUNT  # reading again does not repeat the notice
    (notice,) = recording.notices
    assert "was skipped" in notice


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=150)
@given(
    layout=st.integers(0, len(LAYOUTS) - 1),
    share=st.floats(0, 1),
    rubbish=st.binary(min_size=1, max_size=12),
)
def test_rubbish_anywhere_never_escapes_as_another_error(wholes, tmp_path, layout, share, rubbish):
    damaged = bytearray(wholes[layout])
    start = int(share * (len(damaged) - len(rubbish)))
    damaged[start : start + len(rubbish)] = rubbish
    path = tmp_path / "damaged.mcap"
    path.write_bytes(damaged)
    try:
        recording = Recording(path)
        assert len(list(recording.frames())) <= COUNT
        list(recording.messages())
    except InputError:
        pass


def test_an_absurd_chunk_size_is_not_believed(wholes, tmp_path):
    damaged = bytearray(wholes[2])
    chunk = damaged.index(b"lz4" if b"lz4" in damaged else b"zstd")
    struct.pack_into("<Q", damaged, chunk - 16, 2**62)
    path = tmp_path / "damaged.mcap"
    path.write_bytes(damaged)
    recording = Recording(path)
    assert len(stamps(recording)) < COUNT
    assert "claims to hold" in recording.notices[0]


def chunk(compression, records, size=None):
    """Content of a chunk without a checksum."""
    head = struct.pack("<QQQII", 0, 10, len(records) if size is None else size, 0, len(compression))
    return head + compression + struct.pack("<Q", len(records)) + records


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"no head", "its head is broken"),
        (chunk(b"rar", b"records"), "its compression 'rar' is unknown"),
        (chunk(b"zstd", b"rubbish"), "it cannot be decompressed"),
        (chunk(b"", b"\5\3\0\0\0\0\0\0\0abc"), "a message is too short"),
        # Each nine of its 250 million bytes were taken for an empty record.
        (chunk(b"zstd", ZEROS, 250 * 10**6), "it holds a record of kind 0"),
    ],
)
def test_a_chunk_that_cannot_be_unpacked_says_why(tmp_path, content, said):
    path = tmp_path / "damaged.mcap"
    records = (0x06, content), (0x0F, bytes(4)), (0x02, bytes(20))
    parts = [struct.pack("<BQ", opcode, len(body)) + body for opcode, body in records]
    path.write_bytes(MAGIC + b"".join(parts) + MAGIC)
    (damage,) = read_index(path).damages
    assert said in damage


@pytest.mark.parametrize("layout", [1, 2])
def test_a_chunk_is_unpacked_no_further_than_it_claims(wholes, tmp_path, layout):
    damaged = bytearray(wholes[layout])
    chunk = damaged.index({1: b"lz4", 2: b"zstd"}[layout])
    struct.pack_into("<Q", damaged, chunk - 16, 100)
    path = tmp_path / "damaged.mcap"
    path.write_bytes(damaged)
    recording = Recording(path)
    assert len(stamps(recording)) < COUNT
    assert "checksum is wrong" in recording.notices[0]


def test_a_cut_part_of_a_split_recording_is_named(wholes, tmp_path):
    folder = tmp_path / "bag"
    folder.mkdir()
    (folder / "bag_0.mcap").write_bytes(wholes[0][: len(wholes[0]) // 2])
    (folder / "bag_1.mcap").write_bytes(b"")
    with pytest.raises(InputError, match=r"bag_1\.mcap is not an MCAP file"):
        Recording(folder)
    (folder / "bag_1.mcap").unlink()
    assert "bag_0.mcap is truncated after frame" in " ".join(Recording(folder).notices)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=30)
@given(share=st.floats(0.3, 0.999))  # behind the first chunk
def test_the_truth_of_a_cut_recording_is_whole_up_to_the_cut(record, tmp_path, share):
    folder = tmp_path / "bag"
    if not folder.exists():
        record(24, compression=CompressionType.NONE, size=(240, 240))
    (file,) = folder.glob("*.mcap")
    path = tmp_path / "cut.mcap"
    path.write_bytes(file.read_bytes()[: int(share * file.stat().st_size)])
    recording = Recording(path)
    truth = recording.truth()
    assert len(truth) in {recording.frame_count, recording.frame_count - 1}
    assert recording.first_truth() == next(iter(truth), None)
    for index, found in enumerate(truth):
        assert found.stamp_ns == stamp_of(index)
        assert found.occlusion is truth_of(index).occlusion


def image_bag(bare_mcap, broken, **options):
    """Ten images of which those in `broken` hold too few bytes."""
    bag = bare_mcap(**options)
    camera = bag.channel(messages.IMAGE_TOPIC, messages.IMAGE)
    for index in range(10):
        message = messages.image(stamp_of(index), frame_of(index))
        if index in broken:
            message.data = message.data[:-1]
        bag.add(camera, stamp_of(index), message, messages.IMAGE)
    return bag.close()


def test_a_broken_image_keeps_its_place_and_is_counted_and_said_once(bare_mcap):
    recording = Recording(image_bag(bare_mcap, {0, 4}))
    for _ in range(2):
        images = list(recording.frames())
        assert [image.stamp_ns for image in images] == [stamp_of(index) for index in range(10)]
        assert [i for i, image in enumerate(images) if image.frame is None] == [0, 4]
    (notice,) = recording.notices
    assert notice.startswith("unreadable images of /camera/image_raw")
    assert "2; 0.000 s after the start" in notice
    assert "but has 2303" in notice


def test_images_of_which_none_can_be_read_are_an_input_error(bare_mcap):
    recording = Recording(image_bag(bare_mcap, set(range(10))))
    with pytest.raises(InputError, match=r"no image of /camera/image_raw .* can be read"):
        list(recording.frames())


def test_nine_unreadable_images_at_the_beginning_are_not_the_end(bare_mcap):
    images = list(Recording(image_bag(bare_mcap, set(range(9)))).frames())
    assert [image.frame is None for image in images] == [True] * 9 + [False]


def summary_records(data):
    """Offset, opcode and content length of each record of the summary section."""
    (offset,) = struct.unpack_from("<Q", data, len(data) - 28)
    while offset < len(data) - 8:
        opcode, length = struct.unpack_from("<BQ", data, offset)
        yield offset, opcode, length
        offset += 9 + length


def test_a_summary_whose_checksum_is_wrong_is_not_believed(bare_mcap):
    path = image_bag(bare_mcap, ())
    data = bytearray(path.read_bytes())
    start = next(summary_records(data))[0]
    name = data.index(messages.IMAGE_TOPIC.encode(), start)
    data[name + 1 : name + 7] = b"CAMERA"
    path.write_bytes(data)
    recording = Recording(path)
    assert (recording.image_topic, recording.frame_count) == (messages.IMAGE_TOPIC, 10)


def test_counts_that_do_not_add_up_are_counted_again(bare_mcap):
    path = image_bag(bare_mcap, (), enable_crcs=False)
    data = bytearray(path.read_bytes())
    (end,) = [o + 9 + length for o, opcode, length in summary_records(data) if opcode == 0x0B]
    assert data[end - 8] == 10  # the count of the last, and only, channel
    data[end - 8] = 3
    path.write_bytes(data)
    assert Recording(path).frame_count == 10


def test_a_chunk_that_the_summary_lacks_is_found(bare_mcap):
    path = image_bag(bare_mcap, (), enable_crcs=False, chunk_size=5000)
    data = bytearray(path.read_bytes())
    indexes = [offset for offset, opcode, _ in summary_records(data) if opcode == 0x08]
    assert len(indexes) > 2
    data[indexes[1]] = 0x7F  # a record of an unknown kind, which MCAP says to skip
    path.write_bytes(data)
    assert stamps(Recording(path)) == [stamp_of(index) for index in range(10)]


def test_a_broken_message_is_a_broken_image(bare_mcap):
    bag = bare_mcap()
    camera = bag.channel(messages.IMAGE_TOPIC, messages.IMAGE)
    for number, data in enumerate((b"", b"\0", b"\0\1\0\0", b"\0\1\0\0" + bytes(30), b"\xff" * 99)):
        bag.raw(camera, number, data)
    bag.image(camera, 7)
    recording = Recording(bag.close())
    images = list(recording.frames())
    assert [image.frame is None for image in images] == [True] * 5 + [False]
    assert images[-1].stamp_ns == stamp_of(7)
    assert ": 5;" in recording.notices[0]
    assert len(list(recording.messages())) == 6


def test_a_recording_whose_every_chunk_is_damaged_is_an_input_error(record, tmp_path):
    whole = next(record().glob("*.mcap")).read_bytes()
    path = tmp_path / "damaged.mcap"
    middle = len(whole) // 2
    path.write_bytes(whole[:middle] + bytes([whole[middle] ^ 255]) + whole[middle + 1 :])
    with pytest.raises(InputError, match=r"no image of /camera/image_raw .* checksum is wrong"):
        list(Recording(path).frames())


def test_images_that_only_the_index_knows_are_an_input_error(record, tmp_path):
    whole = bytearray(next(record(compression=CompressionType.NONE).glob("*.mcap")).read_bytes())
    (block,) = Recording(tmp_path / "bag").files[0].blocks
    whole[block.offset] = 0x7F  # a record of an unknown kind, which MCAP says to skip
    path = tmp_path / "damaged.mcap"
    path.write_bytes(whole)
    with pytest.raises(InputError, match=r"no image of /camera/image_raw .* no messages where"):
        list(Recording(path).frames())
