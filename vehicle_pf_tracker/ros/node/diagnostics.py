# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`/diagnostics` at 1 Hz: counts of a node's input and work, and why no images arrive."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rclpy.clock import Clock, ClockType
from rclpy.node import Node

from vehicle_pf_tracker.ros.messages import LEVELS, WAITING, status
from vehicle_pf_tracker.ros.node.image_input import ImageInput

PERIOD = 1.0
SILENCE = 5.0
"""Time without an image after which a warning is published, s."""
_WARNING_PERIOD = 30.0


class Health:
    """Counters since the node was configured; rates since the last report.

    Parameters
    ----------
    clock : callable
        Steady time in s.

    Attributes
    ----------
    images, rejected, dropped : int
        Images that arrived, that could not be used, and that were sent but never arrived.
    refused_targets : int
        Targets that could not be used.
    restarts : int
        Times that the tracker failed twice in a row and started anew.
    last_rejection, last_refusal : str
        The reasons.
    road : mapping
        Place and speed on the road with the last estimate, by name; empty without a road.
    mode : str
        Mode of the last `~/mode`.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self.images = self.rejected = self.dropped = self.refused_targets = 0
        self.restarts = 0
        self.last_rejection = self.last_refusal = ""
        self.mode = WAITING
        self.road: Mapping[str, object] = {}
        self._mode_since = self._heard = self._reported = clock()
        self._images_reported = 0
        self._number: int | None = None
        self._age = 0.0
        self._step_ms = 0.0

    @property
    def silence(self) -> float:
        """Seconds since the last image, or since listening began."""
        return self._clock() - self._heard

    def listen(self) -> None:
        """Start waiting for images: neither the time nor the images missed before count."""
        self._heard = self._clock()
        self._number = None

    def arrived(
        self, info: Mapping[str, Any], age: float, count_publishers: Callable[[], int]
    ) -> None:
        """Count an image.

        Parameters
        ----------
        info : mapping
            The message's info; gaps in its publication sequence number are dropped images.
        age : float
            Time from the image's stamp to now, in s.
        count_publishers : callable
            Returns the number of publishers on the topic; is called where images seem to be
            missing, as the numbers of several publishers cannot be told apart.
        """
        self.images += 1
        self._heard = self._clock()
        self._age = age
        number = info.get("publication_sequence_number")
        if number is not None and self._number is not None:
            # A publisher that was restarted counts from 1 again.
            missing = number - self._number - 1
            if missing > 0 and count_publishers() == 1:
                self.dropped += missing
        self._number = number

    def answered(self, mode: str, step_ms: float | None = None) -> None:
        """Note the mode that an image was answered with, and how long the step took."""
        if mode != self.mode:
            self.mode, self._mode_since = mode, self._clock()
        if step_ms is not None:
            self._step_ms = step_ms

    def reject(self, reason: str) -> None:
        """Count an image that could not be used."""
        self.rejected += 1
        self.last_rejection = reason

    def refuse_target(self, reason: str) -> None:
        """Count a target that could not be used."""
        self.refused_targets += 1
        self.last_refusal = reason

    def report(self) -> dict[str, object]:
        """Give the values for `/diagnostics` by name, and begin the next interval."""
        now = self._clock()
        new = self.images - self._images_reported
        seconds = now - self._reported
        self._images_reported = self.images
        self._reported = now
        return {
            "mode": self.mode,
            "time in mode (s)": round(now - self._mode_since, 1),
            "input rate (Hz)": round(new / seconds, 2) if seconds > 0 else 0.0,
            "age of frames (ms)": round(self._age * 1e3, 1),
            "step time (ms)": round(self._step_ms, 3),
            "images": self.images,
            "dropped": self.dropped,
            "rejected": self.rejected,
            "last rejection": self.last_rejection,
            "refused targets": self.refused_targets,
            "last refused target": self.last_refusal,
            "restarts after errors": self.restarts,
            "time since last image (s)": round(now - self._heard, 1),
            **self.road,
        }


class Diagnostics:
    """Publishes the node's health while it exists.

    Parameters
    ----------
    node : Node
        Node to report on.
    facts : callable
        Returns other values to publish, by name.

    Attributes
    ----------
    health : Health
        Counters since the node was configured.
    source : ImageInput or None
        The open subscription; None while the node is not active.
    """

    def __init__(self, node: Node, facts: Callable[[], Mapping[str, object]]) -> None:
        self._node = node
        self._facts = facts
        self.health = Health()
        self.source: ImageInput | None = None
        self._publisher = node.create_publisher(DiagnosticArray, "/diagnostics", 10)
        # Steady, because simulated time may stand still and that is worth a report too.
        clock = Clock(clock_type=ClockType.STEADY_TIME)
        self._timer = node.create_timer(PERIOD, self.publish, clock=clock)

    def begin(self) -> Health:
        """Reset the counters, and return them."""
        self.health = Health()
        return self.health

    def listen_to(self, source: ImageInput) -> None:
        """Expect images from `source`."""
        self.source = source
        self.health.listen()

    def cease(self) -> None:
        """Close the source and expect nothing."""
        if self.source is not None:
            self.source.close()
        self.source = None

    def publish(self) -> None:
        """Publish one report."""
        publishers = self.source.count_publishers() if self.source else 0
        values = {**self.health.report(), "matched publishers": publishers, **self._facts()}
        level, words = self._judge()
        name = self._node.get_name()
        topic = self.source.topic if self.source else ""
        message = DiagnosticArray(status=[status(level, f"{name}: tracker", words, topic, values)])
        message.header.stamp = self._node.get_clock().now().to_msg()
        self._publisher.publish(message)

    def _judge(self) -> tuple[bytes, str]:
        if self.source is None:
            return DiagnosticStatus.OK, "not active"
        topic = self.source.topic
        level = LEVELS[self.health.mode]
        if self.health.silence < SILENCE:
            return level, self.health.mode
        words = f"no image for {SILENCE:g} s on {topic}: {self.source.explain_silence()}"
        self._node.get_logger().warning(words, throttle_duration_sec=_WARNING_PERIOD)
        return max(level, DiagnosticStatus.WARN), words
