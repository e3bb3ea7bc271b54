"""Messages of one or several MCAP files, merged by log time, a chunk at a time."""

from __future__ import annotations

import heapq
from collections.abc import Callable, Collection, Iterator, Sequence
from typing import TypeAlias

from vehicle_pf_tracker.recordings.mcap_blocks import Block, DamageError, Message, read_block
from vehicle_pf_tracker.recordings.mcap_index import McapIndex

_WHOLE_BLOCK = -1

_Entry: TypeAlias = "tuple[int, int, int, int, Block | Message]"
"""Log time, number of the file, offset of the block, place within it, and what is there. The first
four are unique, so that a heap never compares the last."""


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
        The topics wanted; None for all.
    first_ns, end_ns : int
        Log times wanted: first_ns <= time < end_ns, in ns.
    on_damage : callable
        Told about a block that cannot be read; reading goes on after it.
    """
    wanted = [_channels(index, topics) for index in files]
    heap = _wanted_blocks(files, wanted, first_ns, end_ns)
    heapq.heapify(heap)
    while heap:
        _, number, offset, _, item = heapq.heappop(heap)
        if isinstance(item, Message):
            yield files[number], item
            continue
        try:
            for place, message in enumerate(read_block(files[number].path, item)):
                if (
                    message.channel_id in wanted[number]
                    and first_ns <= message.log_time_ns < end_ns
                ):
                    heapq.heappush(heap, (message.log_time_ns, number, offset, place, message))
        except DamageError as error:
            on_damage(files[number], item, error)


def _channels(index: McapIndex, topics: Collection[str] | None) -> set[int]:
    return {
        channel_id
        for channel_id, channel in index.channels.items()
        if topics is None or channel.topic in topics
    }


def _wanted_blocks(
    files: Sequence[McapIndex], wanted: Sequence[set[int]], first_ns: int, end_ns: int
) -> list[_Entry]:
    return [
        (block.start_ns, number, block.offset, _WHOLE_BLOCK, block)
        for number, index in enumerate(files)
        for block in index.blocks
        if block.end_ns >= first_ns
        and block.start_ns < end_ns
        and (block.channels is None or block.channels & wanted[number])
    ]
