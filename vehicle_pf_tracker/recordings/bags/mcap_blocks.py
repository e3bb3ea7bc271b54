# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The parts of an MCAP file that hold messages, also damaged ones.

The `mcap` package's reader stops with an exception where a file is cut, and loads files without
chunks into memory whole; a recording of a crashed computer is often both. See the MCAP format
specification, sections Records and Chunk (op=0x06).
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import lz4.frame
import zstandard
from mcap.opcode import Opcode

RECORD_HEAD = 9
"""Bytes before a record's content: its opcode (1) and its length (8)."""

# Of a message: channel, sequence number, log time and publish time (ns). Of a chunk: first and last
# log time (ns), bytes unpacked, CRC-32 of these, and letters of the compression's name.
_MESSAGE_HEAD = struct.Struct("<HIQQ")
_CHUNK_HEAD = struct.Struct("<QQQII")
_MAX_CHUNK = 2**28
"""Bytes that a chunk is believed to hold: an image of 30 megapixels, 16 bits and three colours has
180 MB, and recorders close a chunk after about 1 MB."""
_IN_CHUNKS = {Opcode.SCHEMA, Opcode.CHANNEL, Opcode.MESSAGE}
_FOREIGN = 0x80
"""First opcode of records that the MCAP format leaves to applications."""


class DamageError(Exception):
    """A part of a file cannot be read."""


class Message(NamedTuple):
    """A message as it lies in the file; `data` is a view of its chunk."""

    channel_id: int
    log_time_ns: int
    data: memoryview


@dataclass(frozen=True, slots=True)
class Block:
    """A chunk, or a message outside of chunks, and where it lies in the file.

    Attributes
    ----------
    offset, length : int
        Position and size of the record in the file, bytes, its head included.
    start_ns, end_ns : int
        Smallest and largest log time in ns.
    channels : frozenset of int or None
        Channels that have messages in it; None where unknown.
    """

    offset: int
    length: int
    start_ns: int
    end_ns: int
    channels: frozenset[int] | None


def read_span(path: Path, offset: int, length: int) -> bytes:
    """Read `length` bytes of a file, fewer where it ends before."""
    with path.open("rb") as stream:
        stream.seek(offset)
        return stream.read(length)


def read_block(path: Path, block: Block) -> Iterator[Message]:
    """Read the messages of a block in the order of the file.

    Raises
    ------
    DamageError
        If the block cannot be read, is cut shorter than the index says, or its content is damaged.
    """
    try:
        # The whole record at once: a chunk can only be unpacked as a whole.
        record = memoryview(read_span(path, block.offset, block.length))
    except OSError as error:
        raise DamageError(f"it cannot be read ({error.strerror})") from error
    # An index may promise more than a file that was cut still has.
    if len(record) < max(block.length, RECORD_HEAD):
        raise DamageError("the file ends before it")
    if record[0] not in {Opcode.CHUNK, Opcode.MESSAGE}:
        raise DamageError("there are no messages where the index says so")
    for opcode, content in block_records(record[0], record[RECORD_HEAD:]):
        if opcode == Opcode.MESSAGE:
            yield parse_message(content)


def block_records(opcode: int, content: memoryview) -> Iterator[tuple[int, memoryview]]:
    """Split a chunk into its records; any other record is returned as it is.

    Raises
    ------
    DamageError
        If a chunk cannot be unpacked.
    """
    if opcode != Opcode.CHUNK:
        yield opcode, content
        return
    records = _unpack_chunk(content)
    position = 0
    # Bytes that are too few for a head are the rest of a record that was cut.
    while position + RECORD_HEAD <= len(records):
        opcode, length = struct.unpack_from("<BQ", records, position)
        position += RECORD_HEAD
        if opcode not in _IN_CHUNKS and opcode < _FOREIGN:
            raise DamageError(f"it holds a record of kind {opcode}")  # a gigabyte of zeros, too
        # What follows a record that is cut off cannot be found: there is no mark to look for.
        if position + length > len(records):
            break
        yield opcode, records[position : position + length]
        position += length


def parse_message(content: memoryview) -> Message:
    """Split the content of a message record.

    Raises
    ------
    DamageError
        If it is shorter than a message's head.
    """
    if len(content) < _MESSAGE_HEAD.size:
        raise DamageError("a message is too short")
    # The publish time is of no use here: recordings are ordered by the log time.
    channel_id, _, log_time, _ = _MESSAGE_HEAD.unpack_from(content)
    return Message(channel_id, log_time, content[_MESSAGE_HEAD.size :])


def _unpack_chunk(content: memoryview) -> memoryview:
    try:
        _, _, size, checksum, name_length = _CHUNK_HEAD.unpack_from(content)
        name_end = _CHUNK_HEAD.size + name_length
        compression = bytes(content[_CHUNK_HEAD.size : name_end]).decode()
        (packed_size,) = struct.unpack_from("<Q", content, name_end)
    except (struct.error, UnicodeDecodeError):
        raise DamageError("its head is broken") from None
    packed = content[name_end + 8 : name_end + 8 + packed_size]
    records = _decompress(compression, packed, size)
    # A checksum of 0 says that none was written.
    # The size, too: a decompressor that ends early raises nothing.
    if len(records) != size or (checksum and zlib.crc32(records) != checksum):
        raise DamageError("its checksum is wrong")
    return records


def _decompress(compression: str, packed: memoryview, size: int) -> memoryview:
    """Unpack `size` bytes, and no more than one beyond: a chunk may hold more than it claims."""
    # Before unpacking: a damaged size would ask for memory that is not there.
    if size > _MAX_CHUNK:
        raise DamageError(f"it claims to hold {size} bytes")
    try:
        if compression == "lz4":
            return memoryview(lz4.frame.LZ4FrameDecompressor().decompress(packed, size + 1))
        if compression == "zstd":
            with zstandard.ZstdDecompressor().stream_reader(packed) as reader:
                return memoryview(reader.read(size + 1))
    except (RuntimeError, EOFError, zstandard.ZstdError) as error:
        raise DamageError(f"it cannot be decompressed ({error})") from error
    if compression:
        raise DamageError(f"its compression {compression!r} is unknown")
    return packed
