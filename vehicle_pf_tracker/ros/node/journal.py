# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Journal of a node: lines in its log about its images, and counts for its report."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from rclpy.node import Node

from vehicle_pf_tracker.ros.node.health import Health
from vehicle_pf_tracker.ros.node.notices import Notices


class Journal:
    """The log and the counts of a configured node.

    Parameters
    ----------
    node : Node
        For its log.
    health : Health
        Counts what happens.

    Attributes
    ----------
    log : RcutilsLogger
        The node's log.
    warnings, errors : Notices
        Lines in it that would come with every image.
    health : Health
        As given.
    """

    def __init__(self, node: Node, health: Health) -> None:
        self.log = node.get_logger()
        # A line of code each: rclpy refuses to log with two severities from one.
        self.warnings = Notices(lambda words: self.log.warning(words))  # noqa: PLW0108
        self.errors = Notices(lambda words: self.log.error(words))  # noqa: PLW0108
        self.health = health

    def refuse(self, what: str, reason: str) -> None:
        """Report that a target or a selection cannot be used; all vehicles are kept."""
        self.health.refusals.add(reason)
        self.errors.say(what, f"{what} refused: {reason}")

    def note_seed(self, given: int, seed: int) -> None:
        """Log a seed that was drawn since none was given, so that a run can be repeated."""
        if given < 0:
            self.log.info(f"drew the seed {seed}; set it to repeat this run")

    @contextmanager
    def drawing(self, product: str) -> Iterator[None]:
        """Draw for those who look at it; a drawing that fails costs no image its answer."""
        try:
            yield
        except Exception as error:  # OpenCV's errors, memory
            self.warnings.say(product, f"cannot make {product}: {error or type(error).__name__}")
