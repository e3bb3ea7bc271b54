# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Options that several verbs have: a request of theirs inherits them."""

from __future__ import annotations

import argparse
import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle_pf_tracker.cli.option_values import positive, positive_number
from vehicle_pf_tracker.cli.requests import VerbRequest, option, positional, switch
from vehicle_pf_tracker.core.association import PAIRED_WITHIN_S

if TYPE_CHECKING:
    from vehicle_pf_tracker.recordings.source import ImageSource


@dataclass(frozen=True, kw_only=True)
class OverwriteOption(VerbRequest):
    """Request that can replace outputs."""

    overwrite: bool = switch(help="replace outputs that exist")


@dataclass(frozen=True, kw_only=True)
class MaxDiffOption(VerbRequest):
    """Request that associates estimates and truth."""

    max_diff: float = option(
        default=PAIRED_WITHIN_S, metavar="S",
        help=f"largest time between an image and its truth (default: {PAIRED_WITHIN_S:g} s)",
    )  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class RosOptions(VerbRequest):
    """Request that talks to nodes."""

    timeout: float = option(
        type=positive_number, default=10.0, metavar="S",
        help="longest wait for a node in seconds (default: 10)",
    )  # fmt: skip
    ros_args: Sequence[str] = option(
        nargs=argparse.REMAINDER, default=[], metavar="...", help="all words after this go to ROS"
    )


@dataclass(frozen=True, kw_only=True)
class TopicOption(VerbRequest):
    """Request that reads recordings."""

    topic: str | None = option(help="topic of the images, where a recording has several")


@dataclass(frozen=True, kw_only=True)
class SourceOptions(TopicOption):
    """Request that reads images of any source."""

    source: str = positional(
        metavar="SOURCE",
        help="recording, video file, folder of images, number of a camera (0, 1), or URL of a "
        "stream",
    )  # fmt: skip
    fps: float | None = option(
        metavar="HZ", help="frame rate, instead of the one that SOURCE states"
    )

    def open_source(self) -> ImageSource:
        """Open the source; the truth beside its images is not read."""
        from vehicle_pf_tracker.recordings.source import open_source
        from vehicle_pf_tracker.recordings.truth.files import Beside

        return open_source(self.source, topic=self.topic, fps=self.fps, beside=Beside.IGNORED)


@dataclass(frozen=True, kw_only=True)
class IdOption(VerbRequest):
    """Request that reads truth of several targets."""

    id: int | None = option(metavar="N", help="number of the vehicle, where the truth has several")


@dataclass(frozen=True, kw_only=True)
class TruthOptions(IdOption):
    """Request that reads the truth of videos and folders."""

    truth: Path | None = option(
        help="truth of a video or a folder (default: what lies beside a folder's images); "
        "docs/evaluation.md lists the formats",
    )  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class WorkersOption(VerbRequest):
    """Request for work in several processes."""

    workers: int = option(
        type=positive, default=os.cpu_count() or 1, metavar="N",
        help="processes; results do not depend on it (default: one per processor)",
    )  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class SchedulerOption(WorkersOption):
    """Request for work in processes here, or on the machines of a cluster."""

    scheduler: str | None = option(
        metavar="tcp://HOST:8786",
        help="run on the workers of this Dask scheduler instead; docs/scale.md",
    )  # fmt: skip
