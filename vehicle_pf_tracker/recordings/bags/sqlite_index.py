# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The messages of rosbag2's SQLite files, ``.db3``, indexed as those of MCAP files are.

Not through `rosbags`: its reader needs an intact metadata.yaml, which the bag of a crashed computer
lacks, opens no file by itself, and gives up at the first damaged page.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from urllib.parse import quote

from mcap.records import Channel, Schema

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.recordings.bags.mcap_blocks import Block, DamageError, Message
from vehicle_pf_tracker.recordings.bags.mcap_index import McapIndex
from vehicle_pf_tracker.recordings.recording_names import CONVERSION

_TOPICS = "SELECT id, name, type, serialization_format, offered_qos_profiles FROM topics"
_MESSAGES = "SELECT id, topic_id, timestamp, length(data) FROM messages ORDER BY id"
_MESSAGE = "SELECT topic_id, timestamp, data FROM messages WHERE id = ?"


def read_sqlite_index(path: Path) -> McapIndex:
    """Locate the messages of an SQLite file.

    Raises
    ------
    InputError
        If the file cannot be opened or is not a bag in SQLite.
    """
    index = McapIndex(path, read=_read_message, unit="message")
    try:
        with closing(_connected(path)) as database:
            for number, name, kind, encoding, qos in database.execute(_TOPICS):
                metadata = {"offered_qos_profiles": str(qos or "")}
                # A topic's id serves as the channel's and the schema's, which SQLite has none of.
                index.channels[number] = Channel(number, str(name), str(encoding), metadata, number)
                # The definition is empty: it is not needed to read the types of our recordings.
                index.schemas[number] = Schema(number, b"", "ros2msg", str(kind))
            _add_blocks(index, database)
    except sqlite3.Error as error:
        raise InputError(
            f"the recording {path} is not a bag in SQLite that can be read ({error}); perhaps it "
            f"can be converted: {CONVERSION.format(path=path.parent)}"
        ) from None
    return index


def _add_blocks(index: McapIndex, database: sqlite3.Connection) -> None:
    """Add a block for each message, up to the first page that cannot be read."""
    rows = database.execute(_MESSAGES)
    try:
        for number, topic, time_ns, length in rows:
            # SQLite checks no types: a damaged row may have text where a time should be.
            if topic in index.channels and isinstance(time_ns, int) and length:
                block = Block(number, length, time_ns, time_ns, frozenset({topic}))
                index.blocks.append(block)
                index.counts[topic] += 1
            else:
                index.damages.append(f"message {number} was skipped: it has no topic, time or data")
    # The query cannot go on behind a damaged page; the rows before it are used.
    except sqlite3.DatabaseError:
        index.is_truncated = True


def _read_message(path: Path, block: Block) -> Iterator[Message]:
    """Read the message of a block."""
    # Opened for each message: a block is read by its path alone, and iterators share nothing.
    try:
        with closing(_connected(path)) as database:
            row = database.execute(_MESSAGE, (block.offset,)).fetchone()
    except sqlite3.Error as error:
        raise DamageError(f"it cannot be read ({error})") from None
    if row is None or not isinstance(row[2], bytes):
        raise DamageError("it has no data")
    topic, time_ns, data = row
    yield Message(topic, time_ns, memoryview(data))


def _connected(path: Path) -> sqlite3.Connection:
    """Open a file for reading; without the log of a recorder that crashed it cannot change."""
    # `immutable` reads from media that cannot be written; but it ignores the log, in which a
    # recorder that crashed may have left the last messages.
    has_log = path.with_name(path.name + "-wal").exists()
    options = "mode=ro" if has_log else "mode=ro&immutable=1"
    return sqlite3.connect(f"file:{quote(str(path.absolute()))}?{options}", uri=True)
