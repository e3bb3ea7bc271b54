# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Every private name of rclpy that this package uses, with a check and a public way without it.

Private names may change with any release. Each is looked for when a node starts; where one is
missing, the public interface serves instead, with less speed or fewer words, and the node says so.
Tried with rclpy 7.1.6 (Jazzy) and 9.1.2 (Kilted).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import rclpy.impl.implementation_singleton
from rclpy.context import Context
from rclpy.lifecycle import LifecycleNode
from rclpy.node import Node
from rclpy.service import Service
from rclpy.subscription import Subscription
from rclpy.timer import Timer

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


InvalidHandle: type[Exception] = getattr(_compiled, "InvalidHandle", RuntimeError)
_RCLError: type[Exception] = getattr(_compiled, "RCLError", RuntimeError)
_WAIT_METHODS = (
    "add_service",
    "add_subscription",
    "add_timer",
    "clear_entities",
    "get_ready_entities",
    "wait",
)
"""Methods of rclpy's compiled wait set that `EntityWait` calls."""
_TIMER_METHODS = ("call_timer", "is_timer_ready")
"""Methods of rclpy's compiled timers that `run_timer` calls."""


def can_wait_for_entities() -> bool:
    """Return whether `EntityWait`, `run_callback` and `run_timer` work with this rclpy."""
    wait_set = getattr(_compiled, "WaitSet", None)
    timer = getattr(_compiled, "Timer", None)
    take = getattr(getattr(_compiled, "Subscription", None), "take_message", None)
    has_kinds = hasattr(getattr(Subscription, "CallbackType", None), "MessageOnly")
    has_methods = all(hasattr(wait_set, name) for name in _WAIT_METHODS)
    has_methods &= all(hasattr(timer, name) for name in _TIMER_METHODS)
    return take is not None and has_kinds and has_methods


class ReadyEntities(NamedTuple):
    """Entities that are ready.

    Attributes
    ----------
    subscriptions : list of Subscription
        Those with a message, in the order of the nodes.
    timers : list of Timer
        Those that are due.
    has_requests : bool
        True where a service has a request.
    """

    subscriptions: list[Subscription]
    timers: list[Timer]
    has_requests: bool


class EntityWait:
    """Waits for the subscriptions, timers and services of nodes, in a wait set that is kept.

    Parameters
    ----------
    context : Context
        That of the nodes.
    nodes : sequence of Node
        As they are now: once entities were made or destroyed, another `EntityWait` is needed.
    """

    def __init__(self, context: Context, nodes: Sequence[Node]) -> None:
        # By what rcl lists ready ones by.
        self._subscriptions = {
            one.handle.pointer: one for node in nodes for one in node.subscriptions
        }
        self._timers = {one.handle.pointer: one for node in nodes for one in node.timers}
        self._subscription_handles = [one.handle for one in self._subscriptions.values()]
        self._timer_handles = [one.handle for one in self._timers.values()]
        self._services = [one.handle for node in nodes for one in node.services]
        counts = len(self._subscriptions), 0, len(self._timers), 0, len(self._services), 0
        # Without any entity there is nothing to wait for, which rcl takes for a mistake.
        self._wait_set = _compiled.WaitSet(*counts, context.handle) if any(counts) else None

    def wait(self, seconds: float, *, for_requests: bool) -> ReadyEntities:
        """Wait until something is ready; services are left out unless `for_requests`.

        Raises
        ------
        InvalidHandle
            One of the entities was destroyed.
        """
        wait_set = self._wait_set
        if wait_set is None:
            return ReadyEntities([], [], has_requests=False)
        wait_set.clear_entities()  # rcl takes those out that are not ready
        try:
            for subscription in self._subscription_handles:
                wait_set.add_subscription(subscription)
            for timer in self._timer_handles:
                wait_set.add_timer(timer)
            if for_requests:
                for service in self._services:
                    wait_set.add_service(service)
        except _RCLError as error:
            raise InvalidHandle(str(error)) from error
        wait_set.wait(round(seconds * 1e9))
        has_requests = for_requests and bool(wait_set.get_ready_entities("service"))
        return ReadyEntities(
            [self._subscriptions[one] for one in wait_set.get_ready_entities("subscription")],
            [self._timers[one] for one in wait_set.get_ready_entities("timer")],
            has_requests,
        )


def run_timer(timer: Timer) -> None:
    """Call back a timer that is due; rcl lists those too that were cancelled meanwhile."""
    try:
        with timer.handle:
            if not timer.handle.is_timer_ready():
                return
            timer.handle.call_timer()
    except InvalidHandle:  # a callback before has destroyed it
        return
    timer.callback()


def run_callback(subscription: Subscription) -> None:
    """Take a message, if there still is one, and call back with it."""
    try:
        with subscription.handle:
            taken = subscription.handle.take_message(subscription.msg_type, subscription.raw)
    except InvalidHandle:  # a callback before has destroyed it
        return
    if taken is None:
        return
    message, info = taken
    if subscription._callback_type is Subscription.CallbackType.MessageOnly:
        subscription.callback(message)
    else:
        subscription.callback(message, info)
