# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Table of contents of an MCAP file: where its messages are.

The index comes from a file's summary, or from a pass over a file that is cut.
"""

from __future__ import annotations

import io
import struct
import zlib
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import BinaryIO

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.reader import SeekingReader
from mcap.records import Channel, Schema
from mcap.summary import Summary

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.recordings.bags.mcap_blocks import (
    RECORD_HEAD,
    Block,
    DamageError,
    Message,
    block_records,
    parse_message,
    read_block,
    read_span,
)

# First and last bytes of an MCAP file (MCAP format specification, section Magic).
MAGIC = b"\x89MCAP0\r\n"
_FOOTER = struct.pack("<BQ", Opcode.FOOTER, 20)
"""Beginning of the footer record of an MCAP file: its opcode, and the length of its content."""
_TAIL = len(_FOOTER) + 20 + len(MAGIC)
"""Bytes from there to the end of a file that was closed."""


@dataclass
class McapIndex:
    """The table of contents of an MCAP file.

    Attributes
    ----------
    path : Path
        The file.
    channels, schemas : dict
        Channels and schemas by their numbers in the file.
    blocks : list of Block
        Blocks in the order of the file.
    counts : Counter
        Number of messages by channel.
    is_truncated : bool
        True if the file was cut: it lacks its end, or stops within a record.
    damages : list of str
        Other unreadable parts, one clause each.
    read : callable
        Reads the messages of a block of the file.
    unit : str
        Unit of the offsets of the blocks.
    """

    path: Path
    channels: dict[int, Channel] = field(default_factory=dict)
    schemas: dict[int, Schema] = field(default_factory=dict)
    blocks: list[Block] = field(default_factory=list)
    counts: Counter[int] = field(default_factory=Counter)
    is_truncated: bool = False
    damages: list[str] = field(default_factory=list)
    read: Callable[[Path, Block], Iterator[Message]] = read_block
    unit: str = "byte"


def read_index(path: Path) -> McapIndex:
    """Locate the messages of an MCAP file.

    A complete file lists them in its summary; a file without one is read once from begin to end.

    Raises
    ------
    InputError
        If the file cannot be opened or is not an MCAP file.
    """
    try:
        with path.open("rb") as stream:
            size = stream.seek(0, io.SEEK_END)
            stream.seek(0)
            # The magic first: parsing anything else as MCAP gives sentences that help nobody.
            if stream.read(len(MAGIC)) != MAGIC:
                raise InputError(f"the recording {path} is not an MCAP file")
            # The summary is a few kB at the end; a pass over the file reads all of it.
            return _from_summary(path, stream, size) or _scanned(path, stream, size)
    except OSError as error:
        raise InputError(f"cannot read the recording {path}: {error.strerror}") from error


def _from_summary(path: Path, stream: BinaryIO, size: int) -> McapIndex | None:
    """Make the index of the summary, if there is one that can be trusted."""
    summary = _read_summary(stream, size)
    if summary is None or not _is_complete(summary, size):
        return None
    # `_is_complete` is false without statistics.
    assert summary.statistics is not None
    counts = Counter(summary.statistics.channel_message_counts)
    blocks = [
        Block(
            chunk.chunk_start_offset,
            chunk.chunk_length,
            chunk.message_start_time,
            chunk.message_end_time,
            # Offsets are optional: without them the channels are unknown, and not none.
            frozenset(chunk.message_index_offsets) or None,
        )
        for chunk in summary.chunk_indexes
    ]
    return McapIndex(path, summary.channels, summary.schemas, blocks, counts)


def _read_summary(stream: BinaryIO, size: int) -> Summary | None:
    """Read the summary, if the footer's checksum does not contradict it."""
    # The footer of a complete file has a fixed length, so that it is read from the end.
    stream.seek(max(size - _TAIL, 0))
    tail = stream.read()
    # Three signs of a file that was closed: a cut one may end in anything.
    if not (len(tail) == _TAIL and tail.startswith(_FOOTER) and tail.endswith(MAGIC)):
        return None
    start, _, checksum = struct.unpack_from("<QQI", tail, len(_FOOTER))
    end = size - len(MAGIC) - 4  # the checksum covers the footer up to itself
    # A start of 0 says that there is no summary.
    if not len(MAGIC) <= start < end:
        return None
    stream.seek(start)
    if checksum and zlib.crc32(stream.read(end - start)) != checksum:
        return None
    stream.seek(0)
    try:
        return SeekingReader(stream, record_size_limit=size).get_summary()
    # A summary that cannot be read is as good as none: the file is scanned.
    except (McapError, struct.error, ValueError, KeyError, OverflowError):
        return None


def _is_complete(summary: Summary, size: int) -> bool:
    """Return whether channels, schemas and chunks of all messages are listed and in the file."""
    statistics = summary.statistics
    chunks = summary.chunk_indexes
    channels = summary.channels
    if statistics is None:
        return False
    counts = statistics.channel_message_counts
    return (
        # 1. Messages are counted, and all of them lie in chunks that are listed and in the file.
        sum(counts.values()) == statistics.message_count
        and (bool(chunks) or statistics.message_count == 0)
        and len(chunks) == statistics.chunk_count
        and all(chunk.chunk_start_offset + chunk.chunk_length <= size for chunk in chunks)
        # 2. Every channel that has messages is described, and so is its schema; 0 says "none".
        and counts.keys() <= channels.keys()
        and {channel.schema_id for channel in channels.values()} <= {0, *summary.schemas}
    )


def _scanned(path: Path, stream: BinaryIO, size: int) -> McapIndex:
    """Make the index in one pass over a file whose summary is missing or wrong."""
    index = McapIndex(path, is_truncated=True)
    offset = len(MAGIC)
    # From record to record by their lengths: contents that are not needed are never read.
    while True:
        stream.seek(offset)
        head = stream.read(RECORD_HEAD)
        # Opcode 0 is none of the format's: it stands for a file that ends here.
        opcode, length = struct.unpack("<BQ", head) if len(head) == RECORD_HEAD else (0, 0)
        end = offset + RECORD_HEAD + length
        if not opcode or end > size:  # a file system leaves zeros after a power failure
            return index
        if opcode == Opcode.DATA_END:
            # Data that end, in a file without the magic at its end: it was cut as it was closed.
            index.is_truncated = read_span(path, size - len(MAGIC), len(MAGIC)) != MAGIC
            return index
        if opcode in _READERS:
            _add_record(index, opcode, offset, memoryview(stream.read(length)))
        offset = end


def _add_record(index: McapIndex, opcode: int, offset: int, content: memoryview) -> None:
    times: list[int] = []
    channels: Counter[int] = Counter()
    try:
        for kind, record in block_records(opcode, content):
            if kind == Opcode.MESSAGE:
                message = parse_message(record)
                times.append(message.log_time_ns)
                channels[message.channel_id] += 1
            elif kind == Opcode.SCHEMA:
                schema = Schema.read(ReadDataStream(io.BytesIO(record)))
                index.schemas[schema.id] = schema
            elif kind == Opcode.CHANNEL:
                channel = Channel.read(ReadDataStream(io.BytesIO(record)))
                index.channels[channel.id] = channel
    except (DamageError, McapError, struct.error, ValueError) as error:
        index.damages.append(f"a part at byte {offset} was skipped: {error}")
        return
    # A chunk with schemas alone is no block.
    if times:
        length = RECORD_HEAD + len(content)
        block = Block(offset, length, min(times), max(times), frozenset(channels))
        index.blocks.append(block)
        index.counts.update(channels)


_READERS = {Opcode.SCHEMA, Opcode.CHANNEL, Opcode.CHUNK, Opcode.MESSAGE}
