# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Every private name of rclpy that this package uses, with a check and a public way without it.

Private names may change with any release. Each is looked for when a node starts; where one is
missing, the public interface serves instead, with fewer words, and the node says so. Tried with
rclpy 7.1.6 (Jazzy) and 9.1.2 (Kilted).
"""

from __future__ import annotations

from typing import Any

import rclpy.impl.implementation_singleton
from rclpy.lifecycle import LifecycleNode
from rclpy.service import Service

_compiled = getattr(rclpy.impl.implementation_singleton, "rclpy_implementation", None)

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
