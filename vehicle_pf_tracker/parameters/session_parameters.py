"""Parameters of a stream besides its variant's: the target, and what a jump in time does."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.table import group, parameter

_LARGEST = 1e5


@dataclass(frozen=True, slots=True)
class TargetParameters:
    """The box to start on."""

    x: float = parameter(
        0.0,
        "Left edge of the target.",
        minimum=-_LARGEST,
        maximum=_LARGEST,
        unit="px",
        effect="starts",
    )
    y: float = parameter(
        0.0,
        "Top edge of the target.",
        minimum=-_LARGEST,
        maximum=_LARGEST,
        unit="px",
        effect="starts",
    )
    width: float = parameter(
        0.0,
        "Width of the target; 0 waits for a target.",
        minimum=0.0,
        maximum=_LARGEST,
        unit="px",
        effect="starts",
    )
    height: float = parameter(
        0.0,
        "Height of the target; 0 waits for a target.",
        minimum=0.0,
        maximum=_LARGEST,
        unit="px",
        effect="starts",
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
    """What a stream needs besides its variant's parameters."""

    target: TargetParameters = group(TargetParameters)
    reset_on_time_jump: bool = parameter(
        True,
        "Start again on the configured target when stamps go back and stay back (a recording that "
        "loops).",
    )

    def validate(self) -> None:
        """Refuse a target too small for any tracker."""
        box = self.target.box
        if box is not None and min(box.width, box.height) < 1:
            raise InputError(
                f"the target {box} is smaller than one pixel; "
                "give target.width and target.height at least 1, or 0 to wait for a target"
            )
