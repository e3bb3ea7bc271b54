# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Parameters of a node: declared with bounds, unit and source, and set all or none.

Setting goes in rclpy's three steps: before (integers become doubles where those are declared),
on (validate everything, all or nothing), after (apply; in a single-threaded executor that is
between two frames).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    SetParametersResult,
)
from rclpy.exceptions import ParameterNotDeclaredException
from rclpy.node import Node
from rclpy.parameter import Parameter

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.parameters.table import EFFECTS, ParameterSpec, unknown_name

QOS_PREFIX = "qos_overrides."
"""Beginning of the parameters with which ROS lets users change the QoS of a topic."""
_OF_RCLPY = {"use_sim_time", "start_type_description_service"}
"""Parameters that rclpy itself declares."""


def describe(spec: ParameterSpec) -> ParameterDescriptor:
    """Make the descriptor: text with unit, source and effect, range, choices, read-only flag."""
    effect = "set at start-up only" if spec.read_only else f"a change {EFFECTS[spec.effect]}"
    facts = "; ".join(fact for fact in (spec.unit, spec.source, effect) if fact)
    choices = f"one of: {', '.join(spec.choices)}" if spec.choices else ""
    descriptor = ParameterDescriptor(
        name=spec.name,
        description=f"{spec.doc} [{facts}]",
        additional_constraints=choices,
        read_only=spec.read_only,
    )
    if spec.bounds:
        low, high = map(spec.kind, spec.bounds)
        if spec.kind is int:
            descriptor.integer_range = [IntegerRange(from_value=low, to_value=high)]
        else:
            descriptor.floating_point_range = [FloatingPointRange(from_value=low, to_value=high)]
    return descriptor


class UnknownParameterError(ParameterNotDeclaredException):  # type: ignore[misc]
    """Request to set a parameter that the node does not have; rclpy answers it with the reason."""

    def __init__(self, reason: str) -> None:
        # Past rclpy's own words, which leave out the first unknown name, mostly the only one.
        Exception.__init__(self, reason)


class ParameterTable:
    """Declares every parameter on a node and keeps the configuration that they make.

    Parameters
    ----------
    node : Node
        Node to declare them on.
    defaults : Configuration
        Defaults of the node's variant.
    overrides : mapping
        Values taken over the defaults, by name; those of unknown names are passed over.
    check : callable
        Called with each new configuration before it is taken; raises InputError to refuse it.
    changed : callable
        Called with each new configuration that was taken.

    Raises
    ------
    InputError
        Naming every override that does not fit.
    """

    def __init__(
        self,
        node: Node,
        defaults: Configuration,
        overrides: Mapping[str, Any],
        check: Callable[[Configuration], None],
        changed: Callable[[Configuration], None],
    ) -> None:
        self._node = node
        self._specs = defaults.specs()
        self._check = check
        self._changed = changed
        self.configuration = defaults.updated(overrides)
        for name, value in self.configuration.to_mapping().items():
            # The override is in the value already, converted; rclpy refuses 6 where 6.0 is meant.
            node.declare_parameter(name, value, describe(self._specs[name]), ignore_override=True)
        node.add_pre_set_parameters_callback(self._prepare)
        node.add_on_set_parameters_callback(self._validate)
        node.add_post_set_parameters_callback(self._apply)

    def _prepare(self, parameters: list[Parameter]) -> list[Parameter]:
        for one in parameters:
            if not self._node.has_parameter(one.name):
                known = self._node.get_parameters_by_prefix("")
                raise UnknownParameterError(unknown_name(one.name, known))
        return [self._as_declared(one) for one in parameters]

    def _as_declared(self, one: Parameter) -> Parameter:
        # `ros2 param set` makes an integer of 6, where 6.0 is declared.
        spec = self._specs.get(one.name)
        if spec is not None and spec.kind is float and one.type_ is Parameter.Type.INTEGER:
            return Parameter(one.name, Parameter.Type.DOUBLE, float(one.value))
        return one

    def _validate(self, parameters: list[Parameter]) -> SetParametersResult:
        try:
            self._check(self._with(parameters))
        except InputError as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _apply(self, parameters: list[Parameter]) -> None:
        new = self._with(parameters)
        # Setting what is set already must not begin anything anew.
        if new != self.configuration:
            self.configuration = new
            self._changed(new)

    def _with(self, parameters: list[Parameter]) -> Configuration:
        return self.configuration.updated(
            {parameter.name: parameter.value for parameter in parameters}
        )


def take_overrides(node: Node) -> dict[str, Any]:
    """Return the values given to `node` by files and the command line, by parameter name.

    The node was made with `automatically_declare_parameters_from_overrides`, the public way to ask
    for them, and is left as if it had not been.
    """
    given = {name: one.value for name, one in node.get_parameters_by_prefix("").items()}
    # Undeclared again, to be declared with bounds and a description.
    for name in given.keys() - _OF_RCLPY:
        node.undeclare_parameter(name)
    return {name: value for name, value in given.items() if name not in _OF_RCLPY}


def unknown_overrides(node: Node, overrides: Iterable[str], *, qos: bool) -> list[str]:
    """Say which overrides name no declared parameter, and which one may be meant.

    Parameters
    ----------
    node : Node
        rclpy keeps such overrides silently.
    overrides : iterable of str
        Names of the parameters that were given.
    qos : bool
        True to look at the names of QoS overrides, which are declared with their subscription,
        or at all others.
    """
    known = list(node.get_parameters_by_prefix(""))
    return [
        unknown_name(name, known)
        for name in overrides
        if name not in known and name.startswith(QOS_PREFIX) is qos
    ]
