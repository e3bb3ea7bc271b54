# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`replay`: feed a recording to ROS nodes; also installed as `bag_replay`."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle_pf_tracker.cli.console import UsageError, shown_progress, tell_notice, tell_notices
from vehicle_pf_tracker.cli.option_values import number, positive_number
from vehicle_pf_tracker.cli.requests import option, positional, switch
from vehicle_pf_tracker.cli.shared_options import OverwriteOption, RosOptions, TopicOption
from vehicle_pf_tracker.cli.target_options import parse_box
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.outputs import Products, claimed
from vehicle_pf_tracker.recordings.bags.reader import Recording
from vehicle_pf_tracker.results.estimates import write_estimates
from vehicle_pf_tracker.results.output_files import make_folder
from vehicle_pf_tracker.results.run_folder import ESTIMATES_FILE

if TYPE_CHECKING:
    from vehicle_pf_tracker.ros.replay.replay_options import ReplayOptions
    from vehicle_pf_tracker.ros.replay.replay_report import NodeReport, ReplayReport


ANSWERS = (ESTIMATES_FILE, f"*/{ESTIMATES_FILE}")
"""Patterns of the files that `-o` replaces: of one node, and of each of several."""


@contextmanager
def shown_replay() -> Iterator[Callable[[int, float | None], None]]:
    """Return a function that shows a replay's progress."""
    with shown_progress() as show:
        yield lambda frames, share: show(f"played {frames} frame{'s' * (frames > 1)}", share)


def _seconds(text: str) -> float:
    value = number(text)
    if value < 0:
        raise InputError(f"{text} is less than 0")
    return value


def _remapping(text: str) -> tuple[str, str]:
    old, separator, new = text.partition(":=")
    if not (separator and old and new):
        raise InputError(f"{text!r} is not FROM:=TO")
    return _absolute(old), new


def _absolute(topic: str) -> str:
    return "/" + topic.lstrip("/")


@dataclass(frozen=True, kw_only=True)
class Request(TopicOption, OverwriteOption, RosOptions):
    """Request of `replay`, with options named as the rosbag2 player's where it has them."""

    recording: Path = positional(metavar="REC", help="rosbag2 folder or MCAP file")
    rate: float | None = option(
        "-r", type=positive_number, metavar="X", help="speed, 1.0 is as recorded"
    )
    start_offset: float = option(
        type=_seconds, default=0.0, metavar="S", help="skip this many seconds"
    )
    playback_duration: float | None = option(
        type=_seconds, metavar="S", help="play only this many seconds"
    )
    loop: bool = switch("-l", help="restart at the end")
    delay: float = option("-d", type=_seconds, default=0.0, metavar="S", help="wait before playing")
    topics: Sequence[str] = option(
        type=_absolute, nargs="+", default=[], metavar="TOPIC", help="play these topics only"
    )
    remap: Sequence[tuple[str, str]] = option(
        "-m", nargs="+", action="extend", default=[], type=_remapping,
        metavar="FROM:=TO", help="publish a recorded topic under another name",
    )  # fmt: skip
    clock: float | None = option(
        nargs="?", type=positive_number, const=40.0, metavar="HZ",
        help="publish /clock, 40 times a second unless said otherwise",
    )  # fmt: skip
    wait_for_subscribers: bool = switch(help="begin when somebody subscribes to the images")
    lockstep: bool = switch(
        help="publish an image only when every node has answered the one before"
    )
    start_paused: bool = switch(
        "-p",
        help="begin paused; the space bar, or ~/toggle_paused of the player, pauses and continues",
    )
    decompress: bool = switch(help="publish compressed images as raw ones")
    nodes: Sequence[str] = option(
        "--node", action="append", default=[], metavar="NAME",
        help="a tracker node that takes part, repeatable; all that subscribe if none is named",
    )  # fmt: skip
    target: Box | None = option(
        type=parse_box, metavar="X,Y,W,H",
        help="box to start on in px, top-left corner and size; otherwise the first true box",
    )  # fmt: skip
    set_target: bool = option(
        "--no-target", action="store_false",
        help="neither set the nodes' targets nor reset them",
    )  # fmt: skip
    output: Path | None = option(
        "-o", metavar="DIR",
        help="write what the nodes answered: estimates.csv, in a folder for each of several nodes",
    )  # fmt: skip


def run(request: Request) -> int:
    """Play the recording; Ctrl-C ends it normally.

    Raises
    ------
    UsageError
        If options contradict each other, or there is no target to start on.
    """
    if request.target is not None and not request.set_target:
        raise UsageError("--target is not allowed with --no-target; leave one out")
    if request.loop and request.output:
        raise UsageError("-o cannot be combined with --loop, which never ends")
    from vehicle_pf_tracker.ros.replay.replaying import noted_interrupts, replay
    from vehicle_pf_tracker.ros.replay.starting_target import NoTargetError

    recording = Recording(request.recording, request.topic)
    told = recording.notices
    tell_notices(told)
    outputs = [Products(request.output, ANSWERS)] if request.output else []
    with claimed(outputs, (request.recording,), overwrite=request.overwrite), noted_interrupts():
        if request.output:
            make_folder(request.output)
        try:
            with shown_replay() as on_progress:
                report = replay(recording, options_of(request), on_progress, tell_notice)
        except NoTargetError as error:
            raise UsageError(str(error)) from None
        later = [notice for notice in recording.notices if notice not in told]
        tell_notices([*later, *report.notices])
        print(summary(report), flush=True)
        if request.output:
            write_answers(request.output, report.nodes)
    return 0


def options_of(request: Request) -> ReplayOptions:
    """Return the options of the player, most of which are fields of the request."""
    from vehicle_pf_tracker.ros.replay.replay_options import ReplayOptions

    names = {each.name for each in fields(ReplayOptions)} & {each.name for each in fields(request)}
    shared = {name: getattr(request, name) for name in names}
    return ReplayOptions(**{**shared, "remap": dict(request.remap)})


def write_answers(folder: Path, nodes: Sequence[NodeReport]) -> None:
    """Write ``estimates.csv`` into `folder`, or for several nodes into a folder for each.

    Raises
    ------
    InputError
        If one cannot be written.
    """
    for node in nodes:
        place = folder if len(nodes) == 1 else folder / node.name.strip("/").replace("/", "_")
        write_estimates(make_folder(place) / ESTIMATES_FILE, node.rows, node.road)


def summary(report: ReplayReport) -> str:
    """Say what was played and answered, a line for each node."""
    rate = report.frames / report.seconds if report.seconds else 0.0
    end = "interrupted after" if report.interrupted else "played"
    lines = [f"{end} {report.frames} frames in {report.seconds:.1f} s ({rate:.1f} frames/s)"]
    for node in report.nodes:
        unanswered = report.frames - node.answered
        lines.append(f"{node.name}: {node.answered} answered, {unanswered} not")
    return "\n".join(lines)
