# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The session of one target, fed with a node's images.

Kernels may be loaded meanwhile: until then every image is answered with the reason.
"""

from __future__ import annotations

from collections.abc import Mapping

from std_msgs.msg import Header

from vehicle_pf_tracker.core.box import Box, check_target
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.formats.compressed_image import CodedImage
from vehicle_pf_tracker.image.formats.encodings import LARGEST_SIDE_PX
from vehicle_pf_tracker.image.target_checks.stillness import Stillness
from vehicle_pf_tracker.image.target_checks.target_pixels import doubts
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.ros.messages import WAITING_MESSAGE, stamp_ns
from vehicle_pf_tracker.ros.node.answer import Answer, TrackerAnswer
from vehicle_pf_tracker.ros.node.journal import Journal
from vehicle_pf_tracker.ros.node.kernel_loading import KernelLoading
from vehicle_pf_tracker.ros.node.stream_localisation import StreamLocalisation
from vehicle_pf_tracker.trackers.estimate import Estimate, Mode
from vehicle_pf_tracker.trackers.registry import Variant
from vehicle_pf_tracker.trackers.session import Session, TargetError


class TrackerFeed:
    """The session of one target in a configured node.

    Parameters
    ----------
    variant : Variant
        Variant from the registry.
    configuration : Configuration
        Parameters of this variant.
    localisation : StreamLocalisation
        Uncertainty of the estimates, and the road.
    journal : Journal
        Log and counts.

    Attributes
    ----------
    asked : Box or None
        Target that the next image starts on; None where none was given.
    estimate : Estimate or None
        The last one; None while there is no target.
    """

    def __init__(
        self,
        variant: Variant,
        configuration: Configuration,
        localisation: StreamLocalisation,
        journal: Journal,
    ) -> None:
        self._variant = variant
        self._configuration = configuration
        # What the session has of the parameters: it lags while kernels are loaded.
        self._applied = configuration
        self._localisation = localisation
        self._journal = journal
        self._session: Session | None = None
        # Started here, so that it goes on while the node waits for images and for a target.
        self._loading = KernelLoading(variant, configuration.tracker)
        self._target_problem = ""
        self._stillness = Stillness()
        self.asked: Box | None = None
        self.estimate: Estimate | None = None
        if not self.get_ready():
            journal.log.info(self._loading.reason)

    def get_ready(self) -> bool:
        """Make the session, and take new parameters, as soon as their kernels are loaded.

        Returns
        -------
        bool
            True once images can be tracked in.
        """
        # By identity: each change makes another configuration, and comparing all is for each image
        # too much.
        is_applied = self._session is not None and self._applied is self._configuration
        if is_applied or not self._loading.is_done:
            return self._session is not None
        self._applied = self._configuration
        tracker = self._configuration.tracker
        settings = self._configuration.session
        # A seed that was drawn is logged when it is new, and not at each change of parameters.
        seed = None
        if self._session is None:
            self._session = Session(self._variant, tracker, settings)
            for notice in self._session.tracker.kernels.notices:
                self._journal.log.warning(notice)
        else:
            seed = self._session.tracker.seed
            self._session.reconfigure(tracker, settings)
        if self._session.tracker.seed != seed:
            self._journal.note_seed(tracker.seed, self._session.tracker.seed)
        return True

    @property
    def facts(self) -> Mapping[str, object]:
        """The variant, and choices that the parameters leave open: the seed and the kernels."""
        seed = self._configuration.tracker.seed
        kernels = self._loading.reason
        if self._session is not None:
            tracker = self._session.tracker
            seed = tracker.seed
            kernels = tracker.kernels.name
        return {"variant": self._variant.name, "seed": seed, "kernels": kernels}

    @property
    def target_words(self) -> str:
        """Description of the next target, for people."""
        box = self.asked or self._configuration.session.target.box
        return f"following {box}" if box else "waiting for a target on ~/set_target"

    @property
    def box(self) -> Box | None:
        """The present box: that of the estimate, else the configured one."""
        return self.estimate.box if self.estimate else self._configuration.session.target.box

    @property
    def followed(self) -> Box | None:
        """Box of the target while it is visible; None where there is none."""
        estimate = self.estimate
        return estimate.box if estimate and estimate.mode is Mode.TRACKING else None

    @property
    def size(self) -> tuple[int, int] | None:
        """Width and height of the stream's images, px; None before the first."""
        return self._session.size if self._session else None

    def take(self, image: Frame | CodedImage, header: Header, _: object = None) -> Answer:
        """Follow in an image, after the target that was asked for.

        Raises
        ------
        InputError
            If the image cannot be used.
        """
        if not self.get_ready() or self._session is None:
            return self._waiting(header, self._loading.reason)
        try:
            # Kept until the session has it: an image that cannot be read does not lose the target.
            if self.asked is not None:
                self._session.set_target(self.asked)
                self.asked = None
            self.estimate = self._session.feed(image, stamp_ns(header))
        except TargetError as error:
            return self._waiting(header, str(error))
        frame = image.decode() if isinstance(image, CodedImage) else image
        return self._answer(self._session, header, frame)

    def start_on(self, box: Box) -> None:
        """Start on `box` with the next image, if it fits into that.

        Raises
        ------
        InputError
            If it is no box in any image.
        """
        self.asked = check_target(box, LARGEST_SIDE_PX, LARGEST_SIDE_PX)

    def reset(self) -> str:
        """Go back to the configured target, or to waiting for one.

        Raises
        ------
        InputError
            If the kernels are not loaded yet, or the configured target is outside the images, so
            that the next ones will not be tracked in.
        """
        if not self.get_ready() or self._session is None:
            raise InputError(self._loading.reason)
        box = self._configuration.session.target.box
        size = self.size
        self.asked = None
        self.estimate = None
        self._session.reset()
        self._target_problem = ""
        if box is not None and size is not None:
            try:
                check_target(box, *size)
            except InputError as error:
                self._target_problem = str(error)
                raise InputError(f"{error}; waiting for a target") from None
        return self.target_words

    def reconfigure(self, configuration: Configuration) -> None:
        """Take new parameters between two images, or when their kernels are loaded."""
        before = self._configuration
        self._configuration = configuration
        if configuration.session.target != before.session.target:
            self._target_problem = ""
        if configuration.session.road != before.session.road:
            self._localisation.reconfigure(configuration.session.road)
        if configuration.tracker.kernels != self._loading.choice:
            # The session goes on with the kernels that it has until these are there.
            self._loading = KernelLoading(self._variant, configuration.tracker)
        self.get_ready()

    def _waiting(self, header: Header, reason: str) -> Answer:
        """Answer an image in which nothing can be tracked, for this reason."""
        # Once, and not with every image that waits for the same reason.
        if reason not in (self._loading.reason, self._target_problem):
            self._journal.refuse("target", reason)
            self._target_problem = reason
        return Answer(header=header, mode=WAITING_MESSAGE, values={"reason": reason})

    def _answer(self, session: Session, header: Header, frame: Frame) -> TrackerAnswer:
        """Say what the session makes of an image that it took."""
        estimate = self.estimate
        period = session.tracker.frame_period
        mode = WAITING_MESSAGE
        values: dict[str, object] = {}
        sentences = self._events(session)
        if estimate is not None:
            self._target_problem = ""
            mode = estimate.mode.value
            self._localisation.locate(estimate, header, frame, period)
            self._journal.health.road = self._localisation.values
            sentences += self._doubts(header, frame, estimate)
            values = {**estimate.scalars(), **self._journal.health.road}
        elif self._target_problem:
            values["reason"] = self._target_problem
        if sentences:
            values["event"] = "; ".join(sentences)
        return TrackerAnswer(
            header=header,
            mode=mode,
            values=values,
            step_ms=estimate.duration * 1e3 if estimate else None,
            is_doubtful=estimate is not None and self._stillness.is_suspect,
            is_restart=session.recovered,
            frame=frame,
            estimate=estimate,
            period=period,
        )

    def _doubts(self, header: Header, frame: Frame, estimate: Estimate) -> list[str]:
        """Log what speaks against the target, and return it, a sentence each."""
        doubtful = []
        still: list[str] = []
        # Stillness is about one target: with each new one it begins again.
        if estimate.begins:
            self._stillness.begin(estimate.box, stamp_ns(header))
            doubtful = [f"the target is doubtful: {why}" for why in doubts(frame, estimate.box)]
        # A predicted box moves by its model, which is no sign of a vehicle.
        if estimate.mode is Mode.TRACKING:
            still = [*self._stillness.look(frame, estimate.box, stamp_ns(header))]
        # A program may give a target with each image.
        for kind, sentences in (("doubtful", doubtful), ("still", still)):
            if sentences:
                self._journal.warnings.say(kind, "; ".join(sentences))
        return [*doubtful, *still]

    def _events(self, session: Session) -> list[str]:
        """Log what the session says of the last image, and return it, a sentence each."""
        if session.refusal:
            self._journal.health.refusals.add(session.refusal)
        if session.events:
            # A tracker that failed and began anew is an error; other events are warnings.
            log = self._journal.errors if session.recovered else self._journal.warnings
            log.say("event", "; ".join(session.events))
        return [*session.events]
