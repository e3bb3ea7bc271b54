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

"""The node that publishes the images of a source."""

from __future__ import annotations

import threading
import time
from pathlib import Path
from typing import Any

from rclpy.node import Node
from std_msgs.msg import Header

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import frame_size
from vehicle_pf_tracker.recordings.footage import Footage, Picture
from vehicle_pf_tracker.recordings.open_footage import is_live, is_recording, open_footage
from vehicle_pf_tracker.ros.video_source.calibration import read_calibration
from vehicle_pf_tracker.ros.video_source.outputs import ImageOutputs
from vehicle_pf_tracker.ros.video_source.pacing import BackOff, Pace
from vehicle_pf_tracker.ros.video_source.parameters import declare

_NAME = "video_source"
_LATE = 1.0
"""Seconds behind the source's rate that are worth a warning: more than a hiccup of the disk."""
_SAY_AGAIN = 10.0
"""Seconds between two warnings of a kind."""


class VideoSourceNode(Node):  # type: ignore[misc]
    """Publishes images of a source from a thread of its own.

    Parameters
    ----------
    source : str
        Takes the place of the parameter `source` if not empty.
    **keywords
        For `rclpy.node.Node`.

    Attributes
    ----------
    problem : str
        Reason why it ended, as a source that cannot be read; empty at the end of a file.

    Raises
    ------
    InputError
        If there is no source, or a parameter or the calibration cannot be used.
    """

    def __init__(self, source: str = "", **keywords: Any) -> None:
        super().__init__(_NAME, **keywords)
        settings = declare(self)
        self._source_name = source or settings.source
        if not self._source_name:
            raise InputError("give a source: `video_source SOURCE`, or -p source:=SOURCE")
        self._settings = settings
        url = settings.camera_info_url
        self._outputs = ImageOutputs(
            self,
            jpeg_quality=settings.jpeg_quality,
            calibration=read_calibration(url) if url else None,
        )
        self._is_live = False
        self._stop = threading.Event()
        self._pace = Pace(self._now, self._stop)
        self._back_off = BackOff(self._stop)
        self._shown = 0
        self._told: set[str] = set()
        self._broke_at: float | None = None
        self.problem = ""
        # It opens the source too, which may wait for a network: signals are heard meanwhile.
        self._thread = threading.Thread(target=self._run, name="images", daemon=True)
        self._thread.start()

    @property
    def is_done(self) -> bool:
        """True once no image will follow."""
        return not self._thread.is_alive()

    def stop(self, timeout: float) -> bool:
        """End the thread; return False where it still waits for an image after `timeout` s."""
        self._stop.set()
        self._thread.join(timeout)
        return self.is_done

    def _open(self) -> Footage:
        name = self._source_name
        if is_recording(Path(name)):
            raise InputError(f"{name} is a recording; `bag_replay {name}` plays it")
        return open_footage(name, fps=self._settings.fps)

    def _now(self) -> int:
        return int(self.get_clock().now().nanoseconds)

    def _run(self) -> None:
        try:
            self._show_all(self._open())
        except InputError as error:
            self.problem = str(error)
        except Exception as error:
            if self.context.ok():  # otherwise a signal took the ground from under a call
                self.problem = f"{type(error).__name__}: {error}"

    def _show_all(self, opened: Footage) -> None:
        """Show the source, again and again where it is live or looped."""
        goes_on = self._show(opened)
        while goes_on and not self._stop.is_set():
            again = self._opened_again()
            goes_on = again is None or self._show(again)

    def _show(self, source: Footage) -> bool:
        """Show the source until it ends or breaks; return whether it is to be opened again."""
        try:
            self._show_images(source)
        except InputError as error:
            self._note_break(str(error))
            return True
        if self._is_live:
            self._note_break(f"{self._source_name} sends no more images")
            return True
        for notice in source.notices():
            if notice not in self._told:
                self._told.add(notice)
                self.get_logger().warning(notice)
        if not self._settings.loop:
            self.get_logger().info(f"the source has ended after {self._shown} images")
        return self._settings.loop

    def _show_images(self, source: Footage) -> None:
        self._is_live = is_live(source)
        self._pace.begin(is_live=self._is_live)
        for picture in source.pictures():
            if self._stop.is_set():
                return
            self._publish(picture)

    def _publish(self, picture: Picture) -> None:
        stamp = self._pace.stamp(picture.stamp_ns)
        if self._stop.is_set():
            return
        header = Header(frame_id=self._settings.frame_id)
        header.stamp.sec, header.stamp.nanosec = divmod(stamp, 1_000_000_000)
        self._outputs.publish(header, picture.frame)
        if not self._shown:
            width, height = frame_size(picture.frame)
            self.get_logger().info(f"{width}x{height} px on {self._outputs.topic}")
        self._shown += 1
        self._note_image(stamp)

    def _note_image(self, stamp: int) -> None:
        if self._broke_at is not None:
            seconds = time.monotonic() - self._broke_at
            self.get_logger().info(f"images again after {seconds:.1f} s")
            self._broke_at = None
        self._back_off.reset()
        late = (self._now() - stamp) / 1e9
        if late > _LATE and not self._is_live:
            self.get_logger().warning(
                f"images are read slower than the source's rate: {late:.1f} s behind",
                throttle_duration_sec=_SAY_AGAIN,
            )

    def _note_break(self, why: str) -> None:
        """Wait before the next try, or raise where there is none."""
        if not self._is_live and not self._settings.loop:
            raise InputError(why)
        if self._stop.is_set() or not self.context.ok():
            return
        if self._broke_at is None:
            self._broke_at = time.monotonic()
        self.get_logger().warning(
            f"{why}; trying again after {self._back_off.seconds:.0f} s",
            throttle_duration_sec=_SAY_AGAIN,
        )
        self._back_off.wait()

    def _opened_again(self) -> Footage | None:
        """Open the source once more; None where it is not there."""
        try:
            return self._open()
        except InputError as error:
            self._note_break(str(error))
            return None
