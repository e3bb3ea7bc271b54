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

"""Blocks of an MCAP file: its chunks, and messages outside of chunks, read by the library `mcap`.

What the library does not do is here: it bounds what a damaged chunk may cost, and names any damage.
"""

from __future__ import annotations

import io
import struct
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, McapRecord, Message, Schema
from mcap.stream_reader import breakup_chunk
from zstandard import ZstdError

RECORD_HEAD = 9
"""Bytes before a record's content: its opcode (1) and its length (8)."""
_MAX_CHUNK = 2**28
"""Bytes that a chunk is believed to hold: an image of 30 megapixels, 16 bits and three colours has
180 MB, and recorders close a chunk after about 1 MB."""


class DamageError(Exception):
    """A part of a file cannot be read."""


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
        record = read_span(path, block.offset, block.length)
    except OSError as error:
        raise DamageError(f"it cannot be read ({error.strerror})") from error
    if len(record) < max(block.length, RECORD_HEAD):
        raise DamageError("the file ends before it")
    if record[0] not in {Opcode.CHUNK, Opcode.MESSAGE}:
        raise DamageError("there are no messages where the index says so")
    for one in block_records(record[0], record[RECORD_HEAD:]):
        if isinstance(one, Message):
            yield one


def block_records(opcode: int, content: bytes) -> Sequence[McapRecord]:
    """Split a chunk into its records; a message, a channel or a schema is returned alone.

    Raises
    ------
    DamageError
        If it cannot be read.
    """
    stream = ReadDataStream(io.BytesIO(content))
    try:
        if opcode == Opcode.MESSAGE:
            return [Message.read(stream, len(content))]
        if opcode == Opcode.CHANNEL:
            return [Channel.read(stream)]
        if opcode == Opcode.SCHEMA:
            return [Schema.read(stream)]
        chunk = Chunk.read(stream)
        if chunk.uncompressed_size > _MAX_CHUNK:
            raise DamageError(f"it claims to hold {chunk.uncompressed_size} bytes")
        return breakup_chunk(chunk, validate_crc=True)
    except (McapError, struct.error, ValueError, RuntimeError, MemoryError, ZstdError) as error:
        raise DamageError(f"it cannot be read ({type(error).__name__}: {error})") from error
