# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""`replay`: feed a recording to ROS nodes; also installed as `bag_replay`."""

from __future__ import annotations

import argparse
import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle_pf_tracker.cli.console import UsageError, tell_notices
from vehicle_pf_tracker.cli.parameter_options import parse_box
from vehicle_pf_tracker.cli.replay_progress import progress_view
from vehicle_pf_tracker.cli.shared_options import add_overwrite, add_ros_args
from vehicle_pf_tracker.core.outputs import Products, claimed
from vehicle_pf_tracker.evaluation.estimates import write_estimates
from vehicle_pf_tracker.evaluation.output_files import make_folder
from vehicle_pf_tracker.recordings.reader import Recording

if TYPE_CHECKING:
    from vehicle_pf_tracker.ros.replay.replay_options import NodeReport, ReplayOptions, ReplayReport


ANSWERS = ("estimates.csv", "*/estimates.csv")
"""Files of one node, and of each of several."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of this verb, named as the rosbag2 player's where it has them."""
    add = parser.add_argument
    add("recording", type=Path, help="rosbag2 folder or MCAP file")
    add("-r", "--rate", type=_positive, metavar="X", help="speed, 1.0 is as recorded")
    add("--start-offset", type=_seconds, default=0.0, metavar="S", help="skip this many seconds")
    add("--playback-duration", type=_seconds, metavar="S", help="play only this many seconds")
    add("-l", "--loop", action="store_true", help="restart at the end")
    add("-d", "--delay", type=_seconds, default=0.0, metavar="S", help="wait before playing")
    add("--start-paused", action="store_true", help="begin paused, until ~/resume is called")
    add("--topics", nargs="+", default=[], metavar="TOPIC", help="play these topics only")
    add("-e", "--regex", type=_pattern, default="", help="play topics that match this whole")
    add(
        "--exclude", "--exclude-topics", nargs="+", default=[], metavar="TOPIC",
        help="play all but these topics",
    )  # fmt: skip
    add(
        "-x", "--exclude-regex", type=_pattern, default="", metavar="REGEX",
        help="play all but topics that match this whole",
    )  # fmt: skip
    add(
        "--qos-profile-overrides-path", type=Path, metavar="FILE",
        help="YAML of QoS by recorded topic; others are published as recorded, but reliably",
    )  # fmt: skip
    add(
        "-m", "--remap", nargs="+", action="extend", default=[], type=_remapping,
        metavar="FROM:=TO", help="publish a recorded topic under another name",
    )  # fmt: skip
    add(
        "--clock", nargs="?", type=_positive, const=40.0, metavar="HZ",
        help="publish /clock, 40 times a second unless said otherwise",
    )  # fmt: skip
    add(
        "--wait-for-subscribers", action="store_true",
        help="begin when somebody subscribes to the images",
    )  # fmt: skip
    add(
        "--lockstep", action="store_true",
        help="publish an image only when every node has answered the one before",
    )  # fmt: skip
    add("--decompress", action="store_true", help="publish compressed images as raw ones")
    _add_tracking_arguments(parser)


def _add_tracking_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("--topic", metavar="TOPIC", help="the image topic, if the recording has several")
    add(
        "--node", action="append", default=[], metavar="NAME",
        help="a tracker node that takes part, repeatable; all that subscribe if none is named",
    )  # fmt: skip
    target = parser.add_mutually_exclusive_group()
    target.add_argument(
        "--target", type=parse_box, metavar="X,Y,W,H",
        help="box to start on in px, top-left corner and size; otherwise the first true box",
    )  # fmt: skip
    target.add_argument(
        "--no-target", action="store_true", help="neither set the nodes' targets nor reset them"
    )
    add(
        "--timeout", type=_positive, default=10.0, metavar="S",
        help="longest wait for a node in seconds (default: 10)",
    )  # fmt: skip
    add(
        "-o", "--output", type=Path, metavar="DIR",
        help="write what the nodes answered: estimates.csv, in a folder for each of several nodes",
    )  # fmt: skip
    add_overwrite(parser)
    add_ros_args(parser)


def run(args: argparse.Namespace) -> int:
    """Play the recording; Ctrl-C ends it normally.

    Raises
    ------
    UsageError
        If options contradict each other, or there is no target to start on.
    """
    if args.loop and args.output:
        raise UsageError("-o cannot be combined with --loop, which never ends")
    from vehicle_pf_tracker.ros.replay.interruption import noted_interrupts
    from vehicle_pf_tracker.ros.replay.replaying import NoTargetError, replay

    recording = Recording(args.recording, args.topic)
    told = recording.notices
    tell_notices(told)
    outputs = [Products(args.output, ANSWERS)] if args.output else []
    inputs = (args.recording, args.qos_profile_overrides_path)
    with claimed(outputs, inputs, overwrite=args.overwrite), noted_interrupts():
        if args.output:
            make_folder(args.output)
        try:
            with progress_view() as on_progress:
                report = replay(recording, options_of(args), on_progress, _tell)
        except NoTargetError as error:
            raise UsageError(str(error)) from None
        later = [notice for notice in recording.notices if notice not in told]
        tell_notices([*later, *report.notices])
        print(summary(report), flush=True)
        if args.output:
            write_answers(args.output, report.nodes)
    return 0


def options_of(args: argparse.Namespace) -> ReplayOptions:
    """Collect the options of a parsed command line."""
    from vehicle_pf_tracker.ros.replay.recorded_qos import read_qos_overrides
    from vehicle_pf_tracker.ros.replay.replay_options import ReplayOptions

    qos_file = args.qos_profile_overrides_path
    return ReplayOptions(
        rate=args.rate,
        start_offset=args.start_offset,
        playback_duration=args.playback_duration,
        loop=args.loop,
        delay=args.delay,
        start_paused=args.start_paused,
        topics=tuple(map(_absolute, args.topics)),
        regex=args.regex,
        exclude=tuple(map(_absolute, args.exclude)),
        exclude_regex=args.exclude_regex,
        qos=read_qos_overrides(qos_file) if qos_file else {},
        remap=dict(args.remap),
        clock=args.clock,
        wait_for_subscribers=args.wait_for_subscribers,
        lockstep=args.lockstep,
        decompress=args.decompress,
        nodes=tuple(args.node),
        target=args.target,
        set_target=not args.no_target,
        timeout=args.timeout,
        ros_args=tuple(args.ros_args),
    )


def write_answers(folder: Path, nodes: Sequence[NodeReport]) -> list[Path]:
    """Write ``estimates.csv`` into `folder`, or for several nodes into a folder for each.

    Returns
    -------
    list of Path
        The files, in the order of `nodes`.

    Raises
    ------
    InputError
        If one cannot be written.
    """
    paths = []
    for node in nodes:
        place = folder if len(nodes) == 1 else folder / node.name.strip("/").replace("/", "_")
        paths.append(make_folder(place) / "estimates.csv")
        write_estimates(paths[-1], node.rows, node.road)
    return paths


def summary(report: ReplayReport) -> str:
    """Say what was played and answered, a line for each node."""
    rate = report.frames / report.seconds if report.seconds else 0.0
    end = "interrupted after" if report.interrupted else "played"
    lines = [f"{end} {report.frames} frames in {report.seconds:.1f} s ({rate:.1f} frames/s)"]
    for node in report.nodes:
        unanswered = report.frames - node.answered
        lines.append(f"{node.name}: {node.answered} answered, {unanswered} not")
    return "\n".join(lines)


def _tell(sentence: str) -> None:
    tell_notices([sentence])


def _seconds(text: str) -> float:
    value = _number(text)
    if value < 0:
        raise argparse.ArgumentTypeError(f"{text} is less than 0")
    return value


def _positive(text: str) -> float:
    value = _number(text)
    if value <= 0:
        raise argparse.ArgumentTypeError(f"{text} is not more than 0")
    return value


def _number(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"{text!r} is not a number")
    return value


def _pattern(text: str) -> str:
    try:
        re.compile(text)
    except re.error as error:
        raise argparse.ArgumentTypeError(f"{text!r} is not a pattern: {error}") from None
    return text


def _remapping(text: str) -> tuple[str, str]:
    old, separator, new = text.partition(":=")
    if not (separator and old and new):
        raise argparse.ArgumentTypeError(f"{text!r} is not FROM:=TO")
    return _absolute(old), new


def _absolute(topic: str) -> str:
    return "/" + topic.lstrip("/")
