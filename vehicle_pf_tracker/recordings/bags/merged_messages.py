# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Messages of several files together, in the order of their log times."""

from __future__ import annotations

import heapq
from collections.abc import Callable, Collection, Iterator, Sequence
from typing import TypeAlias

from vehicle_pf_tracker.recordings.bags.mcap_blocks import Block, DamageError, Message
from vehicle_pf_tracker.recordings.bags.mcap_index import McapIndex

_WHOLE_BLOCK = -1
"""Offset of a block that is not opened yet, below those of all messages: it sorts before them."""
_Entry: TypeAlias = "tuple[int, int, int, int, Block | Message]"
"""Log time, number of the file, offset of the block, index within it, and the block or message.

The first four are unique, so that a heap never compares the last."""


def merged_messages(
    files: Sequence[McapIndex],
    topics: Collection[str] | None,
    first_ns: int,
    end_ns: int,
    on_damage: Callable[[McapIndex, Block, DamageError], None],
) -> Iterator[tuple[McapIndex, Message]]:
    """Yield messages in the order of their log times, equal ones in the order of the files.

    A chunk is opened when its first message is due, and let go with its last: only chunks that
    overlap in time are in memory together.

    Parameters
    ----------
    files : sequence of McapIndex
        The files, in the order of the recording.
    topics : collection of str or None
        Topics to read; None for all.
    first_ns, end_ns : int
        Log times to read: first_ns <= time < end_ns, in ns.
    on_damage : callable
        Called with a block that cannot be read; reading goes on after it.
    """
    # Channels by file: one topic may have another number in each.
    chosen = [
        {number for number, one in index.channels.items() if topics is None or one.topic in topics}
        for index in files
    ]
    # Only blocks of the topics and times that are asked for are ever opened.
    heap: list[_Entry] = [
        (block.start_ns, number, block.offset, _WHOLE_BLOCK, block)
        for number, index in enumerate(files)
        for block in index.blocks
        if block.end_ns >= first_ns
        and block.start_ns < end_ns
        and (block.channels is None or block.channels & chosen[number])
    ]
    # A heap of blocks and messages: a block stands for its first message until it is opened, and
    # then its messages take its place.
    heapq.heapify(heap)
    while heap:
        _, number, offset, _, item = heapq.heappop(heap)
        if isinstance(item, Message):
            yield files[number], item
            continue
        try:
            for place, message in enumerate(files[number].read(files[number].path, item)):
                if (
                    message.channel_id in chosen[number]
                    and first_ns <= message.log_time_ns < end_ns
                ):
                    heapq.heappush(heap, (message.log_time_ns, number, offset, place, message))
        # Messages before the damage are in the heap already, and are yielded.
        except DamageError as error:
            on_damage(files[number], item, error)
