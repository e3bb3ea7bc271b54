# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Tracker nodes: started as processes of their own, waited for and found by their topics."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from threading import Event
from typing import Any

from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.recordings.bags.messages import (
    COMPRESSED_IMAGE,
    DIAGNOSTIC_ARRAY,
    IMAGE_TYPES,
)

_SLICE = 0.05
"""Longest uninterrupted wait in s: changes of the graph and signals wake no executor."""
SHORTEST_SEARCH = 5.0
"""Shortest search for a node, s: discovery takes no longer on a quiet machine."""
_QUIET = 1.0
"""A search ends so many s after the last node was found: nodes that run already are found in one
burst."""
_MODE = "/mode"
"""End of the topic by which tracker nodes are known."""


class Interrupted(Exception):  # noqa: N818 (no error: the user wants it so)
    """The user asked the replay to end."""


class Spinner:
    """Runs the callbacks of one node while waiting.

    Parameters
    ----------
    node : Node
        The node; its context must outlive this object.
    stop : Event
        Once it is set, every wait ends with `Interrupted`.
    """

    def __init__(self, node: Node, stop: Event) -> None:
        self._executor = SingleThreadedExecutor(context=node.context)
        self._executor.add_node(node)
        self._stop = stop

    def check(self) -> None:
        """Raise `Interrupted` if the user asked to end."""
        if self._stop.is_set():
            raise Interrupted

    def until(self, holds: Callable[[], bool], timeout: float | None = None) -> bool:
        """Wait until `holds()`; False if it does not within `timeout` s (None: however long)."""
        deadline = None if timeout is None else time.monotonic() + timeout
        while not holds():
            self.check()
            left = _SLICE if deadline is None else deadline - time.monotonic()
            if left <= 0:
                return False
            self._executor.spin_once(timeout_sec=min(left, _SLICE))
        return True

    def until_time(self, moment: float) -> None:
        """Wait until the monotonic clock shows `moment` s; one callback runs even if it is late."""
        left = 0.0
        while left >= 0:
            self.check()
            self._executor.spin_once(timeout_sec=min(max(left, 0.0), _SLICE))
            left = moment - time.monotonic()

    def close(self) -> None:
        """Release the node."""
        self._executor.shutdown()


def full_name(name: str) -> str:
    """Return a node's name with its namespace: ``apf_tracker`` is ``/apf_tracker``."""
    return "/" + name.strip("/")


class Lookout:
    """Looks for the tracker nodes that subscribe to a topic.

    Parameters
    ----------
    node : Node
        The player's own node.
    spinner : Spinner
        Waits.
    topic : str
        The images' topic as published.
    """

    def __init__(self, node: Node, spinner: Spinner, topic: str) -> None:
        self._node = node
        self._spinner = spinner
        self._topic = topic

    def await_named(self, names: Iterable[str], timeout: float) -> list[str]:
        """Wait until each of these nodes subscribes; return their full names.

        Raises
        ------
        InputError
            If one does not within `timeout` s, or within `SHORTEST_SEARCH` s if that is longer.
        """
        timeout = max(timeout, SHORTEST_SEARCH)
        wanted = list(dict.fromkeys(map(full_name, names)))
        for name in wanted:
            if not self._spinner.until(self._has_subscribed(name), timeout):
                raise InputError(
                    f"the node {name} does not subscribe to {self._topic} after {timeout:g} s: "
                    f"{self._inputs(name)}"
                )
        return wanted

    def find(self, timeout: float = 0.0) -> list[str]:
        """Find all tracker nodes that subscribe.

        Parameters
        ----------
        timeout : float
            Longest search for the first, s; at least `SHORTEST_SEARCH`.
        """
        found: set[str] = set()
        deadline = time.monotonic() + max(timeout, SHORTEST_SEARCH)

        def grows() -> bool:
            now = self._trackers() & self._subscribers(self._topic)
            is_more = not now <= found
            found.update(now)
            return is_more

        while self._spinner.until(grows, _QUIET if found else deadline - time.monotonic()):
            pass
        return sorted(found)

    def nobody(self) -> str:
        """Explain that no tracker node subscribes, and what the running ones subscribe to."""
        trackers = sorted(self._trackers())
        hint = "is one running and active?" if not trackers else self._inputs(trackers[0])
        return f"no tracker node subscribes to {self._topic}: {hint}"

    def _has_subscribed(self, name: str) -> Callable[[], bool]:
        return lambda: name in self._subscribers(self._topic)

    def _trackers(self) -> set[str]:
        """Full names of all nodes that publish a `~/mode` as trackers do."""
        return {
            topic.removesuffix(_MODE)
            for topic, types in self._node.get_topic_names_and_types()
            if topic.endswith(_MODE)
            and DIAGNOSTIC_ARRAY in types
            and topic.removesuffix(_MODE)
            in map(_owner, self._node.get_publishers_info_by_topic(topic))
        }

    def _subscribers(self, topic: str) -> set[str]:
        return set(map(_owner, self._node.get_subscriptions_info_by_topic(topic)))

    def _inputs(self, name: str) -> str:
        kinds = dict(self._node.get_topic_names_and_types())
        inputs = {
            topic: types
            for topic, types in kinds.items()
            if not set(types).isdisjoint(IMAGE_TYPES) and name in self._subscribers(topic)
        }
        if not inputs:
            return f"{name} takes no images; is it running and active?"
        remedy = "use --remap"
        published = kinds.get(self._topic, [])
        if published and not any(set(published) & set(types) for types in inputs.values()):
            transport = "compressed" if COMPRESSED_IMAGE in published else "raw"
            remedy = f"start it with the parameter image_transport:={transport}"
        return f"{name} takes images from {', '.join(inputs)}; {remedy}"


def _owner(endpoint: Any) -> str:
    return full_name(f"{endpoint.node_namespace}/{endpoint.node_name}")
