# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Incidents of a node: its last seconds as a recording."""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from rclpy.serialization import serialize_message
from sensor_msgs.msg import CompressedImage, Image

from vehicle_pf_tracker.core.addresses import shown_values
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.outputs import output_errors
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.parameters.files import to_yaml
from vehicle_pf_tracker.ros.messages import stamp_ns
from vehicle_pf_tracker.ros.own_files import own_name, ros_folder
from vehicle_pf_tracker.ros.serialized_image import ImageMessage, SerializedImage

_LENGTH = 10.0
"""Seconds that are kept, a choice: an occlusion and what led to it."""
_RAW = "/camera/image_raw", "sensor_msgs/msg/Image"
_TOPICS = {
    Image: _RAW,
    SerializedImage: _RAW,
    CompressedImage: ("/camera/image_raw/compressed", "sensor_msgs/msg/CompressedImage"),
    DiagnosticArray: ("/{}/mode", "diagnostic_msgs/msg/DiagnosticArray"),
}
"""Topic and type in the recording of each kind of message: the images' as camera drivers name
theirs, whatever the node's were remapped to, so that `run` and `replay` need no options."""


class IncidentRecorder:
    """Keeps the messages of the last seconds, and writes them where they are asked for.

    Parameters
    ----------
    name : str
        Full name of the node.
    most_bytes : int
        Bytes of messages to keep at most.
    clock : callable
        Steady time in s.
    """

    def __init__(
        self, name: str, most_bytes: int, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._name = name.strip("/")
        self._most = most_bytes
        self._clock = clock
        self._kept: deque[tuple[float, int, type[Any], bytes, Box | None]] = deque()
        self._bytes = 0
        self._writing: threading.Thread | None = None

    @property
    def count(self) -> int:
        """Number of messages that are kept."""
        return len(self._kept)

    def keep(self, message: ImageMessage | DiagnosticArray, box: Box | None = None) -> None:
        """Keep a message, and let go of old ones; a run can start on the target's `box`."""
        now = self._clock()
        # As bytes, whose size is known, and which nobody changes.
        is_serialized = isinstance(message, SerializedImage)
        data = message.serialized if is_serialized else serialize_message(message)
        self._kept.append((now, stamp_ns(message.header), type(message), data, box))
        self._bytes += len(data)
        while self._kept and (self._bytes > self._most or now - self._kept[0][0] > _LENGTH):
            self._bytes -= len(self._kept.popleft()[3])

    def write(self, configuration: Configuration, tell: Callable[[str], object]) -> Path:
        """Begin to write a recording, with the parameters beside it, and return its folder.

        A thread writes it, while images go on; `tell` takes what came of it, in that thread.

        Raises
        ------
        InputError
            If nothing was kept, or it cannot be written.
        """
        if not self._kept:
            raise InputError("no image has come yet")
        if self._writing is not None and self._writing.is_alive():
            raise InputError("the seconds before are still being written")
        try:  # the one thing of a node that needs more than a robot has from apt
            writer = import_module("vehicle_pf_tracker.recordings.bags.writer").RecordingWriter
        except ModuleNotFoundError as error:
            raise InputError(f"writing a recording needs {error.name} (pip)") from None
        with output_errors(ros_folder()):
            ros_folder().mkdir(parents=True, exist_ok=True)
        folder = ros_folder() / f"{own_name(self._name)}_{time.strftime('%Y%m%d_%H%M%S')}"
        # 1. Copy what is kept, while images wait: the thread must not see them come and go.
        messages = [(_TOPICS[kind], stamp, data) for _, stamp, kind, data, _ in self._kept]
        name = self._name
        # A box that was followed in them becomes the truth, on which a run can start.
        first = next(((stamp, box) for _, stamp, _, _, box in self._kept if box is not None), None)
        text = to_yaml(
            configuration.specs(), shown_values(configuration.to_mapping()), f"{name}'s."
        )

        def write() -> None:
            try:
                with writer(folder, overwrite=True) as recording:
                    for (topic, type_name), stamp, data in messages:
                        recording.write_serialized(topic.format(name), type_name, stamp, data)
                    if first is not None:
                        recording.write_truth(Truth(*first, Occlusion.NONE))
                with output_errors(folder):
                    (folder / "parameters.yaml").write_text(text, encoding="utf-8")
                tell(f"the last seconds are written to {folder}")
            except InputError as error:
                tell(f"the last seconds are not kept: {error}")

        # 2. Write in a thread: seconds on a slow disk would cost as many images.
        self._writing = threading.Thread(target=write)
        self._writing.start()
        return folder
