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

"""Setting of the tracker nodes' target, at the image it belongs to."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.clock import MAX_DIFF, max_diff_ns
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.ros.replay.playable import Playable, PlayableMessage
from vehicle_pf_tracker.ros.replay.replay_options import ReplayOptions
from vehicle_pf_tracker.ros.replay.tracker_link import TrackerLink


@dataclass(frozen=True, slots=True)
class StartingTarget:
    """The box to start on, and the image to start in, counted from 1 in the part played."""

    box: Box
    frame: int = 1


def starting_target(recording: Playable, options: ReplayOptions) -> StartingTarget | None:
    """Choose the target: the one given, else the first true box of the part that is played.

    A true box is started on in the image nearest to it in time, as offline.

    Returns
    -------
    StartingTarget or None
        None without a target and truth.

    Raises
    ------
    InputError
        If no image is near the truth.
    """
    if options.target is not None:
        return StartingTarget(options.target)
    earliest_ns = (first_image(recording, options).stamp_ns or 0) - max_diff_ns(MAX_DIFF)
    truth = recording.first_truth()
    if truth is not None and truth.stamp_ns < earliest_ns:
        truth = next((item for item in recording.truth() if item.stamp_ns >= earliest_ns), None)
    if truth is None:
        return None
    images = recording.messages(
        {recording.image_topic}, options.start_offset, options.playback_duration
    )
    stamps = (image.stamp_ns for image in images if image.stamp_ns is not None)
    frame = nearest_frame(stamps, truth.stamp_ns, max_diff_ns(MAX_DIFF))
    if frame is None:
        raise InputError(
            f"no image that is played is within {MAX_DIFF:g} s of the first truth, "
            f"at {truth.stamp_ns / 1e9:.3f} s; give a target with --target x,y,w,h"
        )
    return StartingTarget(truth.box, frame)


def nearest_frame(stamps: Iterable[int], stamp_ns: int, limit_ns: int) -> int | None:
    """Count the frames from 1 up to the first that is nearer to `stamp_ns` than the next.

    Reads no further than one stamp beyond it; None if it is more than `limit_ns` away.
    """
    followed = itertools.pairwise(itertools.chain(stamps, [None]))
    for number, (current, following) in enumerate(followed, start=1):
        assert current is not None
        distance = abs(current - stamp_ns)
        is_nearest = following is None or abs(following - stamp_ns) >= distance
        if is_nearest and distance <= limit_ns:
            return number
    return None


def first_image(recording: Playable, options: ReplayOptions) -> PlayableMessage:
    """Read the first image of the part that is played.

    Raises
    ------
    InputError
        If there is none in it.
    """
    images = recording.messages(
        {recording.image_topic}, options.start_offset, options.playback_duration
    )
    first = next(images, None)
    if first is None:
        length = (recording.end_ns - recording.start_ns) * 1e-9
        raise InputError(
            f"no image is in the part of {recording.path} that --start-offset and "
            f"--playback-duration choose; it lasts {length:.1f} s"
        )
    return first


class Targets:
    """Sets the nodes on `target` through their parameters.

    A service call ends when the node has accepted the target, so that it cannot overtake an image,
    or be overtaken by one, as a message could.

    Parameters
    ----------
    links : sequence of TrackerLink
        The nodes.
    target : StartingTarget or None
        None leaves the nodes alone.
    """

    def __init__(self, links: Sequence[TrackerLink], target: StartingTarget | None) -> None:
        self._links = links
        self._target = target
        self._is_first_pass = True

    def begin_pass(self) -> None:
        """Reset the nodes onto the target, or to waiting if it is known only later.

        In later passes of a loop the stamps go back, which the nodes notice by themselves.
        """
        if self._target is None or (self._target.frame == 1 and not self._is_first_pass):
            return
        self._is_first_pass = False
        for link in self._links:
            link.set_target(self._target.box if self._target.frame == 1 else None, may_reset=True)
        for link in self._links:
            link.reset()

    def before(self, frame: int) -> None:
        """Set the target right before the image number `frame` if it is the one to start in."""
        if self._target is not None and frame == self._target.frame > 1:
            for link in self._links:
                link.set_target(self._target.box)
