# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Read recordings: rosbag2 folders, and bare files in MCAP or SQLite."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from vehicle_pf_tracker.core.cdr import header_stamp_ns
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.image.formats.compressed_image import decode_compressed
from vehicle_pf_tracker.image.formats.encodings import frame_of_message
from vehicle_pf_tracker.recordings.bags import messages
from vehicle_pf_tracker.recordings.bags.bag_folder import recording_files
from vehicle_pf_tracker.recordings.bags.mcap_blocks import Message
from vehicle_pf_tracker.recordings.bags.mcap_index import McapIndex, read_index
from vehicle_pf_tracker.recordings.bags.merged_messages import merged_messages
from vehicle_pf_tracker.recordings.bags.messages import deserialize
from vehicle_pf_tracker.recordings.bags.read_notices import ReadNotices
from vehicle_pf_tracker.recordings.bags.sqlite_index import read_sqlite_index
from vehicle_pf_tracker.recordings.bags.topic_table import (
    TopicInfo,
    choose_image_topic,
    list_topics,
)
from vehicle_pf_tracker.recordings.bags.truth_messages import (
    TRUTH_TOPICS,
    TRUTH_TYPES,
    truth_from_messages,
)
from vehicle_pf_tracker.recordings.footage import StampedFrame
from vehicle_pf_tracker.recordings.recording_names import SQLITE_SUFFIX

__all__ = ["RecordedMessage", "Recording", "StampedFrame"]

_UNREADABLE_IN_A_ROW = 10
"""Unreadable images at the beginning after which reading stops: a recording of another encoding
fails after a third of a second of video, and one damaged image does not end it."""


@dataclass(frozen=True, slots=True)
class RecordedMessage:
    """A message as it was recorded.

    Attributes
    ----------
    topic, type_name : str
        Topic and type; the type is empty where the recording does not state it.
    log_time_ns : int
        Time of recording, ns.
    stamp_ns : int or None
        Stamp of its header in ns; None for types other than those of our recordings.
    data : bytes
        The message in CDR, encapsulation header included.
    """

    topic: str
    type_name: str
    log_time_ns: int
    stamp_ns: int | None
    data: bytes


class Recording:
    """A rosbag2 folder, or a bare file in MCAP or SQLite.

    Reading streams: no more than the chunks that overlap in time are in memory. Each call of
    `frames`, `messages` and `truth` starts anew, and several may be under way at once.

    Parameters
    ----------
    path : Path or str
        The folder or the file.
    topic : str or None
        The image topic; None takes the only one there is.

    Attributes
    ----------
    path : Path
        Path as given.
    image_topic, image_type : str
        The image topic chosen and its ROS type, Image or CompressedImage.
    frame_count : int
        Number of messages on the image topic.
    topics : tuple of TopicInfo
        All topics, in the order of their first messages.
    start_ns, end_ns : int
        Log times of the first and the last message of any topic, in ns.

    Raises
    ------
    InputError
        If there is no such file, it is neither MCAP nor SQLite, nothing in it can be read, or no
        image topic can be chosen.
    """

    def __init__(self, path: Path | str, topic: str | None = None) -> None:
        self.path = Path(path)
        files, irregularities = recording_files(self.path)
        self.files = [
            read_sqlite_index(file) if file.suffix == SQLITE_SUFFIX else read_index(file)
            for file in files
        ]
        # Before the topics: a recording without a message has none to choose from.
        self._check_readable()
        self.topics: tuple[TopicInfo, ...] = list_topics(self.files)
        chosen = choose_image_topic(self.path, self.topics, topic)
        self.image_topic = chosen.name
        self.image_type = chosen.type_name
        self.frame_count = chosen.message_count
        # There is one at least: that was checked.
        blocks = [block for index in self.files for block in index.blocks]
        self.start_ns = min(block.start_ns for block in blocks)
        self.end_ns = max(block.end_ns for block in blocks)
        self._notices = ReadNotices(self.path, self.image_topic, irregularities, self.files)

    @property
    def notices(self) -> list[str]:
        """Irregularities, a sentence each; the list grows while reading."""
        return self._notices.sentences

    def frames(self) -> Iterator[StampedFrame]:
        """Yield the images as RGB frames, in the order of their log times.

        One that cannot be read has its stamp but no frame; `notices` counts it.

        Raises
        ------
        InputError
            If no image can be read.
        """
        # Held back until one can be read, so that a recording of rubbish is an error.
        unsent: list[StampedFrame] = []
        readable = False
        count = 0
        # An image that cannot be read is yielded, too: a tracker has to know that time passed.
        for count, (_, message) in enumerate(self._select({self.image_topic}), start=1):
            unsent.append(self._decode_or_note(message))
            readable = readable or unsent[-1].frame is not None
            if readable:
                yield from unsent
                unsent.clear()
            elif count == _UNREADABLE_IN_A_ROW:
                break
        # Only where the whole topic was read: a loop that was left has missed the rest on purpose.
        else:
            self._notices.add_missing(self.frame_count - count)
        if not readable:
            raise InputError(
                f"no image of {self.image_topic} in {self.path} can be read; "
                f"{self._notices.first_reason}"
            )

    def truth(self) -> tuple[Truth, ...]:
        """Read the true state of the vehicle in each frame that has one, by stamp.

        Empty where the recording has no truth topics.

        Raises
        ------
        InputError
            If the truth topics are empty, of another type or broken.
        """
        if not self._has_truth():
            return ()
        return self._assemble(self._select(TRUTH_TOPICS))

    def first_truth(self) -> Truth | None:
        """Read the earliest truth alone, without reading the whole recording."""
        if not self._has_truth():
            return None
        # In the order of log times, so that the first stamp is among the first messages. Half a
        # second is a choice: far more than a recorder needs for the three topics of one frame.
        early: list[tuple[McapIndex, Message]] = []
        for entry in self._select(TRUTH_TOPICS):
            # Topics of one stamp may be recorded some time apart.
            if early and entry[1].log_time_ns > early[0][1].log_time_ns + 500_000_000:
                break
            early.append(entry)
        # By the stamp, not by the time of recording: topics of one stamp come one after the other.
        stamps = [header_stamp_ns(message.data) or 0 for _, message in early]
        first = [entry for entry, stamp in zip(early, stamps, strict=True) if stamp == min(stamps)]
        return next(iter(self._assemble(first)), None)

    def messages(
        self,
        topics: Collection[str] | None = None,
        start_offset: float = 0.0,
        duration: float | None = None,
    ) -> Iterator[RecordedMessage]:
        """Yield messages as they were recorded, in the order of their log times.

        Parameters
        ----------
        topics : collection of str or None
            Topics to read; None for all.
        start_offset : float
            Time to skip after the start of the recording, s of log time.
        duration : float or None
            Time to read, s; None reads to the end.
        """
        types = {info.name: info for info in self.topics}
        for index, message in self._select(topics, start_offset, duration):
            info = types[index.channels[message.channel_id].topic]
            is_stamped = info.is_cdr and info.type_name in messages.STAMPED_TYPES
            stamp = header_stamp_ns(message.data) if is_stamped else None
            # A copy: a view would keep its whole chunk in memory.
            yield RecordedMessage(
                info.name, info.type_name, message.log_time_ns, stamp, bytes(message.data)
            )

    def _select(
        self,
        topics: Collection[str] | None,
        start_offset: float = 0.0,
        duration: float | None = None,
    ) -> Iterator[tuple[McapIndex, Message]]:
        first = self.start_ns + round(start_offset * 1e9)
        # The end is exclusive, and the last message shall be read.
        end = self.end_ns + 1
        if duration is not None:
            end = min(end, first + round(duration * 1e9))
        return merged_messages(self.files, topics, first, end, self._notices.add_block)

    def _decode_or_note(self, message: Message) -> StampedFrame:
        try:
            image = deserialize(message.data, self.image_type)
            if self.image_type == messages.COMPRESSED_IMAGE:
                frame = decode_compressed(image.format, image.data)
            else:
                frame = frame_of_message(image)
            return StampedFrame(messages.stamp_ns(image), frame)
        except InputError as error:
            self._notices.add_image(message.log_time_ns, self.start_ns, error)
            # The header may be sound where the image is not; else the time of recording.
            stamp = header_stamp_ns(message.data)
            return StampedFrame(message.log_time_ns if stamp is None else stamp, None)

    def _has_truth(self) -> bool:
        """Return whether there is truth; raise if its topics are there but cannot hold any."""
        # A topic of that name but of another type is another's: its bytes would be misread.
        truth_topics = [info for info in self.topics if info.name in TRUTH_TOPICS]
        for info in truth_topics:
            expected = TRUTH_TYPES[info.name]
            if not info.is_cdr or info.type_name != expected:
                kind = info.type_name or "an unknown type"
                raise InputError(f"the truth topic {info.name} carries {kind}, not {expected}")
        if truth_topics and not any(info.message_count for info in truth_topics):
            raise InputError(f"the truth topics of {self.path} are empty")
        return bool(truth_topics)

    def _assemble(self, selected: Iterable[tuple[McapIndex, Message]]) -> tuple[Truth, ...]:
        by_topic = ((index.channels[one.channel_id].topic, one.data) for index, one in selected)
        received = ((topic, deserialize(data, TRUTH_TYPES[topic])) for topic, data in by_topic)
        try:
            # Of the last file alone: in those before it a frame goes on in the next file.
            return truth_from_messages(received, self.files[-1].is_truncated)
        except InputError as error:
            raise InputError(f"the truth of {self.path} is broken: {error}") from error

    def _check_readable(self) -> None:
        # A recording that was cut gets another sentence than one that never had a message.
        if any(index.blocks for index in self.files):
            return
        if any(index.is_truncated or index.damages for index in self.files):
            raise InputError(
                f"the recording {self.path} is truncated or damaged before its first message; "
                "nothing in it can be used"
            )
        raise InputError(f"the recording {self.path} holds no messages")
