# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Configuration of a node: the parameters of its variant, of its stream and its own."""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from vehicle_pf_tracker.core.box import LARGEST_COORDINATE_PX, Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.road import RoadParameters
from vehicle_pf_tracker.parameters.table import (
    ParameterSpec,
    Value,
    from_mapping,
    group,
    parameter,
    specs,
)
from vehicle_pf_tracker.parameters.table import to_mapping as values_of

_COORDINATES = (-LARGEST_COORDINATE_PX, LARGEST_COORDINATE_PX)
"""Bounds of the position of a target, px."""


@dataclass(frozen=True, slots=True)
class PublishParameters:
    """Switches of the outputs; `~/position`, `~/mode` and `/diagnostics` are always published."""

    box: bool = parameter(True, "Publish ~/box; off saves a message per image.")
    velocity: bool = parameter(True, "Publish ~/velocity; off saves a message per image.")
    particles: bool = parameter(True, "Publish ~/particles while it has subscribers.")
    overlay: bool = parameter(True, "Publish ~/overlay while it has subscribers.")


@dataclass(frozen=True, slots=True)
class NodeParameters:
    """Transport, start-up and outputs of a node."""

    image_transport: str = parameter(
        "raw", "Which images to subscribe to: image, or image/compressed (JPEG or PNG).",
        choices=("raw", "compressed"), read_only=True,
    )  # fmt: skip
    queue_depth: int = parameter(
        1, "Images that may wait: 1 always takes the newest of a live camera, 10 and more keeps "
        "every image of a recording.",
        bounds=(1, 10_000), unit="images", read_only=True,
    )  # fmt: skip
    autostart: bool = parameter(
        True, "Configure and activate at start-up; off waits for a lifecycle manager.",
        read_only=True,
    )  # fmt: skip
    output_frame_suffix: str = parameter(
        "", "Appended to the images' frame_id in outputs that are in pixels (`_px`, for "
        "instance), so that nothing takes them for metres; ~/mode and ~/overlay keep the images' "
        "own.",
    )  # fmt: skip
    keep_target: bool = parameter(
        False, "Write the target's box to ~/.ros once a second, so that a node that was killed and "
        "starts again within 30 s goes on with it.",
        read_only=True,
    )  # fmt: skip
    incident_memory: int = parameter(
        0, "Memory for the images and answers of the last 10 s, which ~/snapshot writes to ~/.ros "
        "as a recording; 0 keeps none.",
        bounds=(0, 100_000), unit="MB", read_only=True,
    )  # fmt: skip
    publish: PublishParameters = group(PublishParameters)


_target_number = functools.partial(parameter, 0.0, unit="px", effect="starts")


@dataclass(frozen=True, slots=True)
class TargetParameters:
    """The box to start on."""

    x: float = _target_number("Left edge of the target.", bounds=_COORDINATES)
    y: float = _target_number("Top edge of the target.", bounds=_COORDINATES)
    width: float = _target_number(
        "Width of the target; 0 waits for a target.", bounds=(0.0, LARGEST_COORDINATE_PX)
    )
    height: float = _target_number(
        "Height of the target; 0 waits for a target.", bounds=(0.0, LARGEST_COORDINATE_PX)
    )

    @property
    def box(self) -> Box | None:
        """The box, or None where there is none to start on.

        A side of 0 is none, so that the four can also be set one after the other.
        """
        if not (self.width and self.height):
            return None
        return Box(self.x, self.y, self.width, self.height)


@dataclass(frozen=True, slots=True)
class SessionParameters:
    """Parameters of a stream, beside those of its variant."""

    target: TargetParameters = group(TargetParameters)
    reset_on_time_jump: bool = parameter(
        True, "Start again on the configured target when stamps go back by a second or more "
        "and stay back (a recording that loops).",
    )  # fmt: skip
    road: RoadParameters = group(RoadParameters)

    def validate(self) -> None:
        """Refuse a target that fits no image, and a road that is none."""
        self.road.validate()
        box = self.target.box
        if box is not None and min(box.centre) < 0:
            raise InputError(
                f"the target {box} has its centre outside every image; give the top-left corner "
                "in px from the image's own"
            )
        if box is not None and min(box.width, box.height) < 1:
            raise InputError(
                f"the target {box} is smaller than one pixel; "
                "give target.width and target.height at least 1, or 0 to wait for a target"
            )


@dataclass(frozen=True, slots=True)
class Configuration:
    """The three parameter tables with their values; the names are distinct over all of them.

    Attributes
    ----------
    tracker : Any
        Parameters of the variant.
    session : SessionParameters
        Parameters of the stream.
    node : NodeParameters
        Parameters of the node.
    """

    tracker: Any
    session: SessionParameters
    node: NodeParameters

    @classmethod
    def of(cls, variant: Any) -> Configuration:
        """Return the defaults of `variant`, an entry of the registry."""
        return cls(variant.parameters(), SessionParameters(), NodeParameters())

    def specs(self) -> dict[str, ParameterSpec]:
        """Return the specification of every parameter by name."""
        return {name: spec for part in self._parts() for name, spec in specs(type(part)).items()}

    def to_mapping(self) -> dict[str, Value]:
        """Return the value of every parameter by name."""
        return {name: value for part in self._parts() for name, value in values_of(part).items()}

    def updated(self, values: Mapping[str, object]) -> Configuration:
        """Put `values` over this configuration, all or nothing; names of others are left out.

        Raises
        ------
        InputError
            Naming every value that does not fit, alone or together with others.
        """
        changed: dict[str, Any] = {}
        problems = []
        for field in dataclasses.fields(self):
            part = getattr(self, field.name)
            own = {name: values[name] for name in specs(type(part)) if name in values}
            if not own:
                continue
            try:
                changed[field.name] = from_mapping(type(part), own, part)
            except InputError as error:
                problems.append(str(error))
        if problems:
            raise InputError("; ".join(problems))
        return dataclasses.replace(self, **changed)

    def _parts(self) -> tuple[Any, ...]:
        return self.tracker, self.session, self.node
