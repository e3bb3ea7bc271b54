# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Node `video_source`: publishes the images of a source, and opens it again when it breaks off."""

from __future__ import annotations

import threading
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from rclpy.node import Node
from rclpy.qos_overriding_options import QoSOverridingOptions
from sensor_msgs.msg import Image
from std_msgs.msg import Header

from vehicle_pf_tracker.core.addresses import without_passwords
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import frame_size
from vehicle_pf_tracker.parameters.table import from_mapping, parameter, specs
from vehicle_pf_tracker.recordings.footage import HIGHEST_FPS, Footage, StampedFrame
from vehicle_pf_tracker.recordings.live_camera import LiveCamera
from vehicle_pf_tracker.recordings.opened_footage import open_footage
from vehicle_pf_tracker.recordings.recording_names import is_recording
from vehicle_pf_tracker.ros.messages import image_message
from vehicle_pf_tracker.ros.node.parameters import describe, take_overrides
from vehicle_pf_tracker.ros.video_source.outage import Outage
from vehicle_pf_tracker.ros.video_source.pace import SourcePace

NODE_NAME = "video_source"
_DEPTH = 5
"""Images kept for a slow subscriber. Reliable, since that serves both kinds of subscribers."""
_LATE = 1.0
"""Seconds behind the source's rate that are worth a warning: more than a hiccup of the disk."""
_SAY_AGAIN = 10.0
"""Seconds between two warnings of a kind: a log of a day without its camera stays readable."""


@dataclass(frozen=True)
class Settings:
    """Parameters of the node, all of them for its start only."""

    source: str = parameter(
        "", "A video file, a folder of images, a camera's index, a stream's URL", read_only=True
    )
    fps: float = parameter(
        0.0, "Frame rate of a folder or a video; 0 takes what it states",
        bounds=(0.0, HIGHEST_FPS), unit="1/s", read_only=True,
    )  # fmt: skip
    loop: bool = parameter(False, "Begin a video or a folder again at its end", read_only=True)
    frame_id: str = parameter("camera", "Frame of the images' headers", read_only=True)


def declare(node: Node) -> Settings:
    """Declare the parameters on `node`, which was made with automatic ones, and return them.

    Raises
    ------
    InputError
        Naming every value that does not fit.
    """
    given = take_overrides(node)
    if isinstance(index := given.get("source"), int):  # of a camera
        given["source"] = str(index)
    settings = from_mapping(Settings, given)
    for name, spec in specs(Settings).items():
        value = getattr(settings, name)
        node.declare_parameter(name, value, describe(spec), ignore_override=True)
    return settings


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
        If there is no source, or a parameter cannot be used.
    """

    def __init__(self, source: str = "", **keywords: Any) -> None:
        super().__init__(
            NODE_NAME, automatically_declare_parameters_from_overrides=True, **keywords
        )
        settings = declare(self)
        self._settings = replace(settings, source=source or settings.source)
        if not self._settings.source:
            raise InputError("give a source: `video_source SOURCE`, or -p source:=SOURCE")
        options = QoSOverridingOptions.with_default_policies()
        self._image = self.create_publisher(Image, "image", _DEPTH, qos_overriding_options=options)
        self._is_live = False
        self._goes_on = False
        self._stop = threading.Event()
        self._pace = SourcePace(self._now, self._stop)
        self._outage = Outage(self._stop)
        self._shown = 0
        self._told: set[str] = set()
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
        name = self._settings.source
        if is_recording(Path(name)):
            raise InputError(f"{name} is a recording; `bag_replay {name}` plays it")
        return open_footage(name, fps=self._settings.fps or None)

    def _now(self) -> int:
        return int(self.get_clock().now().nanoseconds)

    def _run(self) -> None:
        try:
            while self._show() and not self._is_over:
                pass
        except InputError as error:
            self.problem = str(error)
        except Exception as error:
            if self.context.ok():  # otherwise a signal took the ground from under a call
                self.problem = f"{type(error).__name__}: {error}"

    @property
    def _is_over(self) -> bool:
        return self._stop.is_set() or not self.context.ok()

    def _show(self) -> bool:
        """Show the source until it ends or breaks; return whether it is to be opened again."""
        try:
            source = self._open()
            self._is_live = isinstance(source, LiveCamera)
            self._goes_on = self._is_live or self._settings.loop
            self._pace.begin(is_live=self._is_live)
            for picture in source.frames():
                if self._stop.is_set():
                    return False
                self._publish(picture)
            if self._is_live:
                raise InputError(f"{self._settings.source} sends no more images")
        except InputError as error:
            if not self._goes_on:
                raise
            self._await_source(str(error))
            return True
        if not self._is_over:
            self._note_end(source)
        return self._goes_on

    def _publish(self, picture: StampedFrame) -> None:
        stamp = self._pace.stamp(picture.stamp_ns)
        if self._stop.is_set() or picture.frame is None:
            return
        header = Header(frame_id=self._settings.frame_id)
        header.stamp.sec, header.stamp.nanosec = divmod(stamp, 1_000_000_000)
        if not self._shown:
            width, height = frame_size(picture.frame)
            self.get_logger().info(f"{width}x{height} px on {self._image.topic_name}")
        if self._image.get_subscription_count():
            self._image.publish(image_message(header, picture.frame))
        self._shown += 1
        self._note_image(stamp)

    def _note_image(self, stamp: int) -> None:
        seconds = self._outage.end()
        if seconds is not None:
            self.get_logger().info(f"images again after {seconds:.1f} s")
        late = (self._now() - stamp) / 1e9
        if late > _LATE and not self._is_live:
            self.get_logger().warning(
                f"images are read slower than the source's rate: {late:.1f} s behind",
                throttle_duration_sec=_SAY_AGAIN,
            )

    def _note_end(self, source: Footage) -> None:
        for notice in source.notices:
            if notice not in self._told:
                self._told.add(notice)
                self.get_logger().warning(without_passwords(notice))
        if not self._goes_on:
            self.get_logger().info(f"the source has ended after {self._shown} images")

    def _await_source(self, why: str) -> None:
        """Say why there are no images, and wait before the next try."""
        if self._is_over:
            return
        self._outage.begin()
        words = f"{why}; trying again after {self._outage.next_wait:.0f} s"
        self.get_logger().warning(words, throttle_duration_sec=_SAY_AGAIN)
        self._outage.wait()
