# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The answer of a node to one image, as its outputs publish it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from std_msgs.msg import Header

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.trackers.estimate import Estimate


@dataclass(frozen=True, slots=True, kw_only=True)
class Answer:
    """Answer to an image, also to one that cannot be used.

    Attributes
    ----------
    header : Header
        Header of the image.
    mode : str
        Mode of the estimate, `WAITING` or `REJECTED`.
    values : mapping
        Values beside the mode: the estimate's, or a reason.
    step_ms : float or None
        Time of the step; None where there was none.
    is_doubtful : bool
        True where the target may be no vehicle: the level is at least WARN.
    is_restart : bool
        True where the tracker failed twice in a row, and started anew in this image.
    """

    header: Header
    mode: str
    values: Mapping[str, object] = field(default_factory=dict)
    step_ms: float | None = None
    is_doubtful: bool = False
    is_restart: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class TrackerAnswer(Answer):
    """Answer of a tracker to an image that it could use.

    Attributes
    ----------
    frame : (H, W, 3) array
        The image.
    estimate : Estimate or None
        None without a target.
    period : float
        Nominal time between images, s.
    """

    frame: Frame
    estimate: Estimate | None
    period: float
