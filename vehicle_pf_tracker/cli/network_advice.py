# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Advice to use a network, where motion joins vehicles in blobs, with the line to type."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from pathlib import Path

from vehicle_pf_tracker.following.known_networks import NETWORKS
from vehicle_pf_tracker.trackers.traffic.session import DetectionTotals

_AMBIGUOUS = 0.35
"""Share of images with ambiguous blobs above which a network counts better: on clips with truth, at
.28 and .30 counts at lines were within one of ten, from .45 on a tenth to all were missed."""
_OWN = "--detector"
"""Option that chooses motion, and cannot stand beside `--model`."""


def network_advice(command: Sequence[str], folder: Path, found: DetectionTotals) -> list[str]:
    """Return a sentence where a network would have counted better; else none.

    Parameters
    ----------
    command : sequence of str
        Command line of a run by motion.
    folder : Path
        Folder of its results.
    found : DetectionTotals
        What motion has detected in it.
    """
    if found.ambiguous <= _AMBIGUOUS * found.images:
        return []
    network = next(iter(NETWORKS))
    words = [word for word in command if not word.startswith(f"{_OWN}=")]
    if _OWN in words:
        at = words.index(_OWN)
        words[at : at + 2] = []
    line = shlex.join([*words, "--model", network, "-o", f"{folder}_{network}"])
    share = found.ambiguous / found.images
    return [
        f"in {share:.0%} of the images blobs may have held several vehicles; a network tells them "
        f"apart: {line}"
    ]
