# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Writing a recording: a rosbag2 folder with one MCAP file, which appears whole or not at all."""

from __future__ import annotations

from contextlib import ExitStack, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mcap.well_known import MessageEncoding, Profile, SchemaEncoding
from mcap.writer import CompressionType, Writer

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.core.outputs import BAG_INFORMATION, check_free, output_errors, whole_folder
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.recordings.bags import messages, truth_messages
from vehicle_pf_tracker.recordings.bags.bag_folder import RELIABLE_QOS, bag_information, to_yaml
from vehicle_pf_tracker.recordings.bags.messages import definition, serialize, type_hash


def _check_replaceable(target: Path, overwrite: bool) -> None:
    if not target.exists():
        return
    if not target.is_dir():
        raise InputError(f"the output {target} is a file; name a folder")
    if not overwrite:
        check_free(target)
    names = [path.name for path in target.iterdir()]
    # Never a folder with anything else in it, whatever --overwrite says.
    # A recording of ours has metadata and MCAP files only.
    if any(name != BAG_INFORMATION and not name.endswith(".mcap") for name in names):
        raise InputError(f"the output folder {target} holds more than a recording; choose another")


@dataclass(slots=True)
class _Channel:
    channel_id: int
    type_name: str
    count: int = 0


class RecordingWriter:
    """Writes a recording; a context manager.

    The folder appears when the block ends well. If it ends with an error nothing is left behind.
    Messages are logged at their stamp.

    Parameters
    ----------
    folder : Path
        The rosbag2 folder to write.
    compression : CompressionType
        Compression of the chunks of the MCAP file.
    overwrite : bool
        Replace a recording that is already there.

    Raises
    ------
    InputError
        If the folder is not empty or cannot be written; also later, when the disk is full.
    """

    def __init__(
        self,
        folder: Path,
        *,
        compression: CompressionType = CompressionType.LZ4,
        overwrite: bool = False,
    ) -> None:
        self.folder = Path(folder)
        target = self.folder.expanduser().resolve()
        self._file_name = f"{target.name}_0.mcap"
        self._channels: dict[str, _Channel] = {}
        self._schemas: dict[str, int] = {}
        self._times: tuple[int, int] | None = None
        # A failure here closes and removes what was opened; without one that is __exit__'s task.
        with output_errors(self.folder), ExitStack() as output:
            _check_replaceable(target, overwrite)
            # Written beside the target, and moved there when all is well.
            self._partial = output.enter_context(whole_folder(target))
            self._stream = (self._partial / self._file_name).open("wb")
            output.callback(self._close)
            self._mcap = Writer(self._stream, compression=compression)
            self._mcap.start(profile=Profile.ROS2, library="vehicle_pf_tracker")
            self._output = output.pop_all()

    def __enter__(self) -> RecordingWriter:
        return self

    def __exit__(self, *failure: Any) -> None:
        # On a failure of the block the partial folder is removed, and nothing of it read again.
        if failure[0] is not None:
            self._output.__exit__(*failure)
            return
        with output_errors(self.folder), self._output:
            first, last = self._times or (0, 0)
            counts = {name: (one.type_name, one.count) for name, one in self._channels.items()}
            information = bag_information(self._file_name, first, last - first, counts)
            # 1. The metadata in the MCAP file as well, as rosbag2 has them: it may be copied alone.
            self._mcap.add_metadata("rosbag2", {"serialized_metadata": to_yaml(information)})
            # 2. The summary: without it every reader would have to scan the file.
            self._mcap.finish()  # type: ignore[no-untyped-call]
            self._stream.close()
            text = to_yaml({"rosbag2_bagfile_information": information})
            (self._partial / "metadata.yaml").write_text(text, encoding="utf-8")

    def _close(self) -> None:
        # What could not be written was reported already; closing tries to flush it once more.
        with suppress(OSError):
            self._stream.close()

    def write_image(self, stamp_ns: int, frame: Frame) -> None:
        """Write an RGB frame as a raw image."""
        self.write(messages.IMAGE_TOPIC, messages.IMAGE, stamp_ns, messages.image(stamp_ns, frame))

    def write_compressed(self, stamp_ns: int, image_format: str, data: bytes) -> None:
        """Write the bytes of a ``jpeg`` or ``png`` file as a compressed image."""
        message = messages.compressed_image(stamp_ns, image_format, data)
        self.write(messages.COMPRESSED_TOPIC, messages.COMPRESSED_IMAGE, stamp_ns, message)

    def write_truth(self, truth: Truth) -> None:
        """Write the truth of one frame, at the stamp of its image."""
        for topic, message in truth_messages.truth_to_messages(truth).items():
            self.write(topic, truth_messages.TRUTH_TYPES[topic], truth.stamp_ns, message)

    def write(self, topic: str, type_name: str, stamp_ns: int, message: Any) -> None:
        """Write any message of a type that `messages.message_class` knows.

        Raises
        ------
        InputError
            If the type is unknown, another type was written to the topic, or the disk is full.
        """
        self.write_serialized(topic, type_name, stamp_ns, serialize(message, type_name))

    def write_serialized(
        self, topic: str, type_name: str, stamp_ns: int, data: bytes | memoryview
    ) -> None:
        """Write a message that is serialized already, as a reader returned it."""
        channel = self._channel(topic, type_name)
        with output_errors(self.folder):
            self._mcap.add_message(
                channel.channel_id,
                stamp_ns,
                data,  # type: ignore[arg-type]  # any buffer is written as it is
                stamp_ns,
                sequence=channel.count,
            )
        channel.count += 1
        first, last = self._times or (stamp_ns, stamp_ns)
        # Messages need not come in order, and the metadata state the first and the last.
        self._times = min(first, stamp_ns), max(last, stamp_ns)

    def _channel(self, topic: str, type_name: str) -> _Channel:
        if topic not in self._channels:
            # One schema serves all topics of a type.
            if type_name not in self._schemas:
                self._schemas[type_name] = self._mcap.register_schema(
                    type_name, SchemaEncoding.ROS2, definition(type_name).encode()
                )
            metadata = {
                "offered_qos_profiles": to_yaml(RELIABLE_QOS),
                # As rosbag2 writes it: types of one name may differ.
                "topic_type_hash": type_hash(type_name),
            }
            channel_id = self._mcap.register_channel(
                topic, MessageEncoding.CDR, self._schemas[type_name], metadata
            )
            self._channels[topic] = _Channel(channel_id, type_name)
        channel = self._channels[topic]
        if channel.type_name != type_name:
            raise InputError(f"the topic {topic} carries {channel.type_name}, not {type_name}")
        return channel
