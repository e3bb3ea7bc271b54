# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Every private name of rclpy that this package uses, with a check and a public way without it.

Private names may change with any release. Each is looked for when a node starts; where one is
missing, the public interface serves instead, with less speed or fewer words, and the node says so.
Tried with rclpy 7.1.6 (Jazzy) and 9.1.2 (Kilted).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import rclpy.impl.implementation_singleton
from rclpy.context import Context
from rclpy.lifecycle import LifecycleNode
from rclpy.node import Node
from rclpy.service import Service
from rclpy.subscription import Subscription

_compiled: Any = getattr(rclpy.impl.implementation_singleton, "rclpy_implementation", None)

RCLError: type[Exception] = getattr(_compiled, "RCLError", RuntimeError)
"""Failure of a call into rcl; its public base class is RuntimeError."""

UnknownROSArgsError: type[Exception] = getattr(_compiled, "UnknownROSArgsError", RuntimeError)
"""Arguments after ``--ros-args`` that ROS does not know; its public base is RuntimeError too."""


def change_state_service(node: LifecycleNode) -> Service | None:
    """Return the service ``~/change_state``, whose callback may be replaced; None if hidden."""
    service = getattr(node, "_service_change_state", None)
    return service if callable(getattr(service, "callback", None)) else None


def state_label(node: LifecycleNode) -> str:
    """Return the label of the node's lifecycle state; empty where rclpy hides it."""
    machine = state_machine(node)
    return str(machine.current_state[1]) if machine is not None else ""


def destroy_state_machine(node: LifecycleNode) -> None:
    """Destroy the services of a destroyed node's state machine, which `destroy_node` leaves."""
    destroy = getattr(state_machine(node), "destroy_when_not_in_use", None)
    if destroy is not None:
        destroy()


def state_machine(node: LifecycleNode) -> Any | None:
    """Return the node's state machine; None where rclpy hides it."""
    machine = getattr(node, "_state_machine", None)
    return machine if hasattr(machine, "current_state") else None


_InvalidHandle: type[Exception] = getattr(_compiled, "InvalidHandle", RuntimeError)
_WAIT_METHODS = (
    "add_service",
    "add_subscription",
    "add_timer",
    "clear_entities",
    "get_ready_entities",
    "wait",
)
"""Methods of rclpy's compiled wait set that `EntityWait` calls."""


def can_wait_for_entities() -> bool:
    """Return whether `EntityWait` and `run_callback` work with this rclpy."""
    wait_set = getattr(_compiled, "WaitSet", None)
    take = getattr(getattr(_compiled, "Subscription", None), "take_message", None)
    has_kinds = hasattr(getattr(Subscription, "CallbackType", None), "MessageOnly")
    return take is not None and has_kinds and all(hasattr(wait_set, name) for name in _WAIT_METHODS)


class EntityWait:
    """Waits for the subscriptions, timers and services of nodes, in a wait set that is kept.

    Parameters
    ----------
    context : Context
        That of the nodes.
    """

    def __init__(self, context: Context) -> None:
        self._context = context
        self._counts: tuple[int, int, int] | None = None
        self._wait_set: Any = None

    def wait(self, nodes: Sequence[Node], seconds: float) -> tuple[list[Subscription], bool]:
        """Wait until something is ready.

        Returns
        -------
        list of Subscription, bool
            Those that are ready; and whether timers or services are.
        """
        subscriptions = [one for node in nodes for one in node.subscriptions]
        timers = [one for node in nodes for one in node.timers]
        services = [one for node in nodes for one in node.services]
        counts = len(subscriptions), len(timers), len(services)
        if not any(counts):
            return [], False
        if counts != self._counts:
            self._counts = counts
            self._wait_set = _compiled.WaitSet(
                counts[0], 0, counts[1], 0, counts[2], 0, self._context.handle
            )
        wait_set = self._wait_set
        wait_set.clear_entities()  # rcl takes those out that are not ready
        for subscription in subscriptions:
            wait_set.add_subscription(subscription.handle)
        for timer in timers:
            wait_set.add_timer(timer.handle)
        for service in services:
            wait_set.add_service(service.handle)
        wait_set.wait(round(seconds * 1e9))
        ready = wait_set.get_ready_entities("subscription")
        has_others = wait_set.get_ready_entities("timer") or wait_set.get_ready_entities("service")
        messages = [one for one in subscriptions if one.handle.pointer in ready] if ready else []
        return messages, bool(has_others)


def run_callback(subscription: Subscription) -> None:
    """Take a message, if there still is one, and call back with it."""
    try:
        with subscription.handle:
            taken = subscription.handle.take_message(subscription.msg_type, subscription.raw)
    except _InvalidHandle:  # a callback before has destroyed it
        return
    if taken is None:
        return
    message, info = taken
    if subscription._callback_type is Subscription.CallbackType.MessageOnly:
        subscription.callback(message)
    else:
        subscription.callback(message, info)
