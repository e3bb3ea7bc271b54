"""Setting the tracker nodes on their target, at the image it is known for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from vehicle_pf_tracker.features.box import Box
from vehicle_pf_tracker.features.errors import InputError
from vehicle_pf_tracker.ros.playable import Playable, PlayableMessage
from vehicle_pf_tracker.ros.replay_options import ReplayOptions
from vehicle_pf_tracker.ros.tracker_link import TrackerLink


@dataclass(frozen=True, slots=True)
class StartingTarget:
    """The box to start on, and the stamp in ns of the image from which on it is known.

    `stamp_ns` is None where it holds from the first image that is played.
    """

    box: Box
    stamp_ns: int | None = None


def starting_target(recording: Playable, options: ReplayOptions) -> StartingTarget | None:
    """Choose the target: the one given, else the first true box of the part that is played."""
    if options.target is not None:
        return StartingTarget(options.target)
    truth = recording.first_truth()
    begin_ns = first_image(recording, options).stamp_ns or 0
    if truth is not None and truth.stamp_ns < begin_ns:
        truth = next((item for item in recording.truth() if item.stamp_ns >= begin_ns), None)
    if truth is None:
        return None
    return StartingTarget(truth.box, truth.stamp_ns if truth.stamp_ns > begin_ns else None)


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

    A service call ends when the node has taken the target, so that it cannot overtake an image, or
    be overtaken by one, as a message could.

    Parameters
    ----------
    links : sequence of TrackerLink
        The nodes.
    target : StartingTarget or None
        None leaves the nodes alone.
    image_topic : str
        The recorded topic whose stamps count.
    """

    def __init__(
        self, links: Sequence[TrackerLink], target: StartingTarget | None, image_topic: str
    ) -> None:
        self._links = links
        self._target = target
        self._image_topic = image_topic
        self._pending = False
        self._is_first_pass = True

    def begin_pass(self) -> None:
        """Reset the nodes onto the target, or to waiting if it is known only later.

        In later passes of a loop the stamps go back, which the nodes notice by themselves.
        """
        is_late = self._target is not None and self._target.stamp_ns is not None
        if self._target is None or not (self._is_first_pass or is_late):
            return
        self._is_first_pass = False
        self._pending = is_late
        for link in self._links:
            link.set_target(None if is_late else self._target.box)
        for link in self._links:
            link.reset()

    def before(self, message: PlayableMessage) -> None:
        """Set the target right before the image that it belongs to."""
        if not self._pending or message.topic != self._image_topic or message.stamp_ns is None:
            return
        assert self._target is not None and self._target.stamp_ns is not None
        if message.stamp_ns >= self._target.stamp_ns:
            self._pending = False
            for link in self._links:
                link.set_target(self._target.box)
