# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The request of `python -m laboratory faults`: its options."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_pf_tracker.cli.option_values import positive
from vehicle_pf_tracker.cli.requests import VerbRequest, option, positional, switch

FAULT_KINDS = ("messages", "parameters", "recordings", "detector", "soak")


@dataclass(frozen=True, kw_only=True)
class Request(VerbRequest):
    """Request of the faults."""

    kinds: tuple[str, ...] = positional(
        nargs="*", choices=(*FAULT_KINDS, []), metavar="KIND",
        help=f"faults to give: {', '.join(FAULT_KINDS)} (default: all of them)",
    )  # fmt: skip
    count: int = option(
        type=positive, default=300, metavar="N",
        help="messages, and files of each kind (default: 300)",
    )  # fmt: skip
    variant: str = option(default="pf", help="node that gets the messages (default: pf)")
    seconds: float = option(
        type=float, default=6.0, help="length of each fault of a detector (default: 6)"
    )
    only: str = option(default="", help="only faults of a detector with this in their name")
    nodes: str = option(
        default="traffic,fusion", metavar="NAME,…",
        help="nodes of the soak, which get the same images (default: traffic,fusion)",
    )  # fmt: skip
    minutes: float = option(type=float, default=1.0, help="length of the soak (default: 1)")
    rate: float = option(type=float, default=15.0, help="its images per second (default: 15)")
    share: float = option(
        type=float, default=0.3,
        help="its faulty images per good one (default: 0.3); with 0 its detector never fails",
    )  # fmt: skip
    every: float = option(
        type=float, default=9.0, help="its images from one vehicle to the next (default: 9)"
    )
    motion: bool = switch(help="traffic detects motion; else it gets detections by a topic")
    best_effort: bool = switch(help="the soak's images may get lost, as those of a camera")
    seed: int = option(type=int, default=0, help="seed of all that is drawn (default: 0)")
