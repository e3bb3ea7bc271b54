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

"""Every private name of rclpy that this package uses, with a check and a public way without it.

Private names may change with any release. Each is looked for when a node starts; where one is
missing, the public interface serves instead, with less speed or fewer words, and `missing` says
what is lost. Tried with rclpy 7.1.6 (Jazzy) and 9.1.2 (Kilted).
"""

from __future__ import annotations

import contextlib
import inspect
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import rclpy.impl.implementation_singleton
from rcl_interfaces.msg import ParameterDescriptor
from rclpy.executors import (
    Executor,
    ShutdownException,
    SingleThreadedExecutor,
    TimeoutException,
)
from rclpy.lifecycle import LifecycleNode
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.service import Service
from rclpy.subscription import Subscription
from rclpy.task import Task
from rclpy.timer import Timer

_compiled = getattr(rclpy.impl.implementation_singleton, "rclpy_implementation", None)

RCLError: type[Exception] = getattr(_compiled, "RCLError", RuntimeError)
"""Failure of a call into rcl; its public base class is RuntimeError."""

UnknownROSArgsError: type[Exception] = getattr(_compiled, "UnknownROSArgsError", RuntimeError)
"""Arguments after ``--ros-args`` that ROS does not know; its public base is RuntimeError too."""

_HANDLER = ["self", "entity", "node", "take_from_wait_list"]
"""Parameters of `Executor._make_handler` in the releases tried."""


def missing(node: Node) -> list[str]:
    """List the features that this rclpy lacks for `node`, a sentence each, with the fallback."""
    sentences = []
    if not can_run_directly():
        sentences.append("its executor differs: images cost more CPU time in the public one")
    if _overrides(node) is None:
        sentences.append("its parameter overrides are hidden: misspelt names are not reported")
    if isinstance(node, LifecycleNode) and _state_machine(node) is None:
        sentences.append("its state machine is hidden: failed transitions are reported without why")
    return sentences


def parameter_overrides(node: Node, names: Sequence[str]) -> dict[str, Any]:
    """Return the values given to `node` by files and the command line, by parameter name.

    Parameters
    ----------
    node : Node
        On which none of `names` is declared yet.
    names : sequence of str
        The parameters to ask for where rclpy hides its own list; others are not found then.
    """
    overrides = _overrides(node)
    if overrides is not None:
        return {name: override.value for name, override in overrides.items()}
    return _declared_overrides(node, names)


def change_state_service(node: LifecycleNode) -> Service | None:
    """Return the service ``~/change_state``, whose callback may be replaced; None if hidden."""
    service = getattr(node, "_service_change_state", None)
    return service if callable(getattr(service, "callback", None)) else None


def state_label(node: LifecycleNode) -> str:
    """Return the label of the node's lifecycle state; empty where rclpy hides it."""
    machine = _state_machine(node)
    return str(machine.current_state[1]) if machine is not None else ""


def destroy_state_machine(node: LifecycleNode) -> None:
    """Destroy the services of a destroyed node's state machine, which `destroy_node` leaves."""
    destroy = getattr(_state_machine(node), "destroy_when_not_in_use", None)
    if destroy is not None:
        destroy()


def can_run_directly() -> bool:
    """Return whether `DirectExecutor` works with this rclpy."""
    make_handler = getattr(Executor, "_make_handler", None)
    wait = getattr(Executor, "_wait_for_ready_callbacks", None)
    if make_handler is None or wait is None:
        return False
    waits_for_some = "nodes" in inspect.signature(wait).parameters
    marks_entities = "_executor_event" in make_handler.__code__.co_names
    same_handler = list(inspect.signature(make_handler).parameters) == _HANDLER
    return waits_for_some and marks_entities and same_handler


class MessageSources:
    """The subscriptions, timers and services of a node, in the form of a node with nothing else.

    Looking through the node's two dozen event handlers for each image would take longer than
    waiting.
    """

    clients = guards = waitables = ()

    def __init__(self, node: Node) -> None:
        self._node = node

    @property
    def subscriptions(self) -> Iterator[Subscription]:
        """The node's present subscriptions."""
        return iter(self._node.subscriptions)

    @property
    def timers(self) -> Iterator[Timer]:
        """The node's present timers."""
        return iter(self._node.timers)

    @property
    def services(self) -> Iterator[Service]:
        """The node's present services."""
        return iter(self._node.services)


class DirectExecutor(SingleThreadedExecutor):  # type: ignore[misc]
    """A single thread that runs the callbacks of subscriptions and services without tasks.

    They have to be plain functions, no coroutines. Only where `can_run_directly` is true.
    """

    def run_one(
        self, timeout_sec: float | None, sources: Sequence[MessageSources] | None = None
    ) -> Any | None:
        """Run one callback and return its entity; None if none was ready in time.

        Parameters
        ----------
        timeout_sec : float or None
            Longest wait in s; None waits as long as it takes.
        sources : sequence of MessageSources, optional
            Wait for these alone; for everything unless given.
        """
        try:
            task, entity, _ = self.wait_for_ready_callbacks(timeout_sec, sources)
        except (ShutdownException, TimeoutException):
            return None
        task()
        if isinstance(task, Task) and task.exception() is not None:
            raise task.exception()
        return entity

    def _make_handler(
        self, entity: Any, node: Node, take_from_wait_list: Callable[..., Any]
    ) -> Any:
        # rclpy's task triggers the executor's guard condition, for other threads that there are
        # none of here, and the next wait ends at once for it.
        # One request at a time: clients keep ten answers by default and lose what comes faster.
        if not isinstance(entity, Subscription | Service):
            return super()._make_handler(entity, node, take_from_wait_list)
        entity._executor_event = True
        return lambda: _handle(entity, take_from_wait_list)


def _handle(entity: Any, take: Callable[[Any], Any]) -> None:
    """Take what is ready at an entity and run its callback."""
    entity._executor_event = False
    if not entity.callback_group.beginning_execution(entity):
        return
    try:
        execute = take(entity)
        if execute is not None:
            with contextlib.suppress(StopIteration):  # how a coroutine that never waits ends
                execute().send(None)
    finally:
        entity.callback_group.ending_execution(entity)


def _overrides(node: Node) -> Mapping[str, Parameter] | None:
    found = getattr(node, "_parameter_overrides", None)
    return found if isinstance(found, Mapping) else None


def _declared_overrides(node: Node, names: Sequence[str]) -> dict[str, Any]:
    """Declare each name without a type, read the value that an override gave it, undeclare it."""
    found = {}
    for name in names:
        descriptor = ParameterDescriptor(dynamic_typing=True)
        value = node.declare_parameter(name, None, descriptor).value
        if value is not None:
            found[name] = value
        node.undeclare_parameter(name)
    return found


def _state_machine(node: Node) -> Any | None:
    machine = getattr(node, "_state_machine", None)
    return machine if hasattr(machine, "current_state") else None
