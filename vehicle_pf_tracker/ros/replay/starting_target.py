# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The target that nodes start on in a replay, and the image to start in."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from vehicle_pf_tracker.core.association import PAIRED_WITHIN_S, is_nearest, max_diff_ns
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.following.offline_tracker import with_next
from vehicle_pf_tracker.recordings.bags.reader import RecordedMessage, Recording
from vehicle_pf_tracker.ros.replay.replay_options import ReplayOptions
from vehicle_pf_tracker.ros.replay.tracker_link import TrackerLink


class NoTargetError(InputError):
    """Tracker nodes are there, but no target for them."""


def played(
    recording: Recording, options: ReplayOptions, topics: set[str]
) -> Iterator[RecordedMessage]:
    """Read the messages of `topics` in the part that is played."""
    return recording.messages(topics, options.start_offset, options.playback_duration)


def starting_target(recording: Recording, options: ReplayOptions) -> tuple[Box, int]:
    """Choose the target: the one given, else the first true box of the part that is played.

    A true box is started on in the image nearest to it in time, as offline.

    Returns
    -------
    (Box, int)
        The box, and the image to start in, counted from 1 in the part played.

    Raises
    ------
    NoTargetError
        If there is neither a target nor truth.
    InputError
        If no image is near the truth.
    """
    if options.target is not None:
        return options.target, 1
    earliest_ns = (first_image(recording, options).stamp_ns or 0) - max_diff_ns(PAIRED_WITHIN_S)
    truth = recording.first_truth()
    if truth is not None and truth.stamp_ns < earliest_ns:
        truth = next((item for item in recording.truth() if item.stamp_ns >= earliest_ns), None)
    if truth is None:
        raise NoTargetError(
            f"the recording {recording.path} has no true box to start on; "
            "give --target x,y,w,h, or --no-target to leave the nodes' targets alone"
        )
    images = played(recording, options, {recording.image_topic})
    stamps = (image.stamp_ns for image in images if image.stamp_ns is not None)
    frame = nearest_frame(stamps, truth.stamp_ns, max_diff_ns(PAIRED_WITHIN_S))
    if frame is None:
        raise InputError(
            f"no image that is played is within {PAIRED_WITHIN_S:g} s of the first truth, "
            f"at {truth.stamp_ns / 1e9:.3f} s; give a target with --target x,y,w,h"
        )
    return truth.box, frame


def nearest_frame(stamps: Iterable[int], stamp_ns: int, limit_ns: int) -> int | None:
    """Count the frames from 1 up to the first that is nearer to `stamp_ns` than the next.

    Reads no further than one stamp beyond it; None if it is more than `limit_ns` away.
    """
    numbered = enumerate(with_next(stamps), start=1)
    return next((n for n, pair in numbered if is_nearest(*pair, stamp_ns, limit_ns)), None)


def first_image(recording: Recording, options: ReplayOptions) -> RecordedMessage:
    """Read the first image of the part that is played.

    Raises
    ------
    InputError
        If there is none in it.
    """
    first = next(played(recording, options, {recording.image_topic}), None)
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
    target : (Box, int) or None
        As `starting_target` returns it; None leaves the nodes alone.
    """

    def __init__(self, links: Sequence[TrackerLink], target: tuple[Box, int] | None) -> None:
        self._links = links
        self._target = target
        self._is_first_pass = True

    def begin_pass(self) -> None:
        """Reset the nodes onto the target, or to waiting if it is known only later.

        In later passes of a loop the stamps go back, which the nodes notice by themselves.
        """
        if self._target is None:
            return
        box, frame = self._target
        if frame > 1 or self._is_first_pass:
            for link in self._links:
                link.set_target(box if frame == 1 else None, may_reset=True)
            for link in self._links:
                link.reset()
        self._is_first_pass = False

    def before(self, frame: int) -> None:
        """Set the target right before the image number `frame` if it is the one to start in."""
        if self._target is not None and frame == self._target[1] > 1:
            for link in self._links:
                link.set_target(self._target[0])
