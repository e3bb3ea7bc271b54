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
        CPU of a node's process for each image.
    """

    name: str
    nodes: int
    rate_hz: float
    sent: int
    lost: int
    cpu_ms: float
