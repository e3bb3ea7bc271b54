# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Delivery of images sent to several nodes at once."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Delivery:
    """Images sent to `nodes` nodes at `rate_hz` each, reliably.

    Attributes
    ----------
    sent, lost : int
        Images that were published, and those that no estimate was given for.
    cpu_ms : float
        CPU of all processes for each image.
    memory_mb : float
        Resident memory of all processes, what they share counted once.
    """

    name: str
    nodes: int
    rate_hz: float
    sent: int
    lost: int
    cpu_ms: float
    memory_mb: float
