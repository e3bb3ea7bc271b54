# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Base of the nodes that take images: lifecycle, parameters, diagnostics, warnings.

It says why a transition failed, and no request can end it: rclpy swallows the exceptions of
transition callbacks, and lets a transition that does not exist in the present state end the
process.
"""

from __future__ import annotations

import traceback
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from functools import partial
from typing import Any

from lifecycle_msgs.srv import ChangeState
from rclpy.clock import Clock, ClockType
from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from rclpy.subscription import Subscription
from rclpy.timer import Timer
from std_srvs.srv import Trigger

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.ros import rclpy_internals
from vehicle_pf_tracker.ros.messages import stamp_ns
from vehicle_pf_tracker.ros.node.diagnostics import Diagnostics
from vehicle_pf_tracker.ros.node.image_input import ImageInput
from vehicle_pf_tracker.ros.node.image_path import Feed, ImagePath
from vehicle_pf_tracker.ros.node.parameters import ParameterTable, take_overrides, unknown_overrides
from vehicle_pf_tracker.ros.serialized_image import ImageMessage

_REQUEST_DEPTH = 10
"""Requests for a change that may wait: ROS's usual depth, more than people send at once."""


class ImageNode(LifecycleNode, ABC):  # type: ignore[misc]
    """Managed node that takes images; active at once unless `autostart` is false.

    A subclass sets what its methods refer to, and then calls `begin`. Of `configure`, `activate`,
    `deactivate` and `cleanup`, an `InputError` leaves the node in the state that it was in; any
    other exception takes it back to unconfigured. The two that undo may be called in any state.

    Attributes
    ----------
    failure : str
        Reason of the last transition that failed; empty before one did.
    path : ImagePath or None
        Where images go; None while the node is not configured.
    accept : callable or None
        Takes each image: the path, or what lies before it; None while the node is not configured.
    feed : Feed or None
        Tracker of one target or of traffic behind the path; None while the node is not configured.
    table : ParameterTable
        The parameters.
    diagnostics : Diagnostics
        Reports on /diagnostics.
    overrides : dict
        Values given by files and the command line, by parameter name.
    inputs : list of Subscription
        Subscriptions that a deactivation ends, beside that to images.
    held : ExitStack
        Releases all that a clean-up ends.
    """

    path: ImagePath | None
    feed: Feed | None

    def __init__(self, name: str, **options: Any) -> None:
        super().__init__(name, automatically_declare_parameters_from_overrides=True, **options)
        # Before any declaration: afterwards a value that a user gave looks like a default.
        self.overrides = take_overrides(self)
        self.failure = ""
        self.path = None
        self.feed = None
        self.accept: Callable[[ImageMessage], None] | None = None
        self.inputs: list[Subscription] = []
        self.held = ExitStack()
        # rclpy answers a request without a reason; ours is wrapped around its own callback.
        service = rclpy_internals.change_state_service(self)
        if service is not None:
            service.callback = partial(self._answer_change_state, service.callback)

    def begin(self, defaults: Configuration) -> None:
        """Declare the parameters, warn of what is not understood, and start.

        Raises
        ------
        InputError
            If a parameter or a QoS override does not fit; the node is destroyed.
        """
        try:
            given = self.overrides
            self.table = ParameterTable(self, defaults, given, self._check, self._reconfigure)
            self.diagnostics = Diagnostics(
                self, lambda: self.feed.facts if self.feed is not None else {}
            )
            if rclpy_internals.state_machine(self) is None:
                words = "this release of rclpy was not tried: its state machine is hidden"
                self.get_logger().warning(f"{words}; failed transitions are reported without why")
            # Before the start, which may fail: a misspelt parameter is perhaps why.
            self.warn_of_overrides(qos=False)
            # Last: a configured node may get an image at once.
            if self.table.configuration.node.autostart:
                self.start()
        except InputError:
            self.destroy_node()
            raise

    def _check(self, configuration: Configuration) -> None:
        """Refuse parameters that do not fit what the node is doing."""
        if self.path is not None:
            self.path.check(configuration)

    def _reconfigure(self, configuration: Configuration) -> None:
        """Take parameters that were changed."""
        if self.path is not None:
            self.path.reconfigure(configuration)

    def open_images(self) -> ImageInput:
        """Listen to images."""
        own = self.table.configuration.node
        source = ImageInput(
            self, own.image_transport, own.queue_depth, self._on_image, self._leave_out
        )
        self.diagnostics.listen_to(source)
        return source

    def listen(
        self, kind: Any, topic: str, what: str, change: Callable[[Any, Any], object]
    ) -> None:
        """Subscribe until the node is deactivated, to requests for a change of `what`.

        `change` takes a message and the path; where it raises InputError, the reason is reported.
        """

        def take(message: Any) -> None:
            if self.path is None:
                return
            try:
                change(message, self.path)
            except InputError as error:
                # A wrong request of another node must not end this one.
                self.path.refuse(what, str(error))

        self.inputs.append(self.create_subscription(kind, topic, take, _REQUEST_DEPTH))

    def serve(self, name: str, act: Callable[[], str]) -> None:
        """Offer a service until clean-up; `act` returns words for people, or raises InputError."""

        def respond(_: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
            try:
                response.success = True
                response.message = act()
            except InputError as error:
                response.success = False
                response.message = str(error)
            return response

        self.held.callback(self.destroy_service, self.create_service(Trigger, name, respond))

    def poll(self, interval: float, callback: Callable[[], None]) -> Timer:
        """Call back every `interval` s until clean-up; of real time: simulated may stand still."""
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        timer = self.create_timer(interval, callback, clock=steady)
        self.held.callback(self.destroy_timer, timer)
        return timer

    @abstractmethod
    def activate(self) -> None:
        """Begin to listen."""

    @abstractmethod
    def prepare(self) -> None:
        """Make path, feed, outputs and services; `held` releases them, also where this fails."""

    def configure(self) -> None:
        """Prepare for images."""
        try:
            self.prepare()
            assert self.feed is not None
            assert self.path is not None
            self.serve("~/reset", self.feed.reset)
            if self.path.incidents is not None:
                self.serve("~/snapshot", self.path.write_incident)
        except Exception:  # of whatever a network or numba raises
            self.cleanup()
            raise

    def deactivate(self) -> None:
        """Close the inputs: an inactive node pays nothing for images."""
        self.diagnostics.cease()
        while self.inputs:
            self.destroy_subscription(self.inputs.pop())

    def cleanup(self) -> None:
        """Release session, outputs and services."""
        # Resources first, in the reverse of their order; then nothing refers to them.
        self.held.close()
        self.path = None
        self.feed = None
        self.accept = None

    def _on_image(self, image: ImageMessage, info: Mapping[str, Any]) -> None:
        """Note an image, and pass it on; not one that a deactivation has overtaken."""
        source = self.diagnostics.source
        if source is None or self.accept is None:
            return
        # By ROS's clock, which stamps are of; all waiting is measured by the steady one.
        age = self.get_clock().now().nanoseconds - stamp_ns(image.header)
        self.diagnostics.health.arrivals.add(info, age * 1e-9, source.count_publishers)
        # Counted first: an image that fails has arrived, too.
        self.accept(image)

    def _leave_out(self, reason: str) -> None:
        """Report a message that is no image; without a header it has no answer."""
        if self.path is not None:
            self.path.journal.health.rejections.add(reason)
            self.path.journal.errors.say("no image", f"image left out: {reason}")

    def warn_of_overrides(self, *, qos: bool) -> None:
        """Log the overrides that are ignored, a line each: of QoS, once all topics are open."""
        for sentence in unknown_overrides(self, self.overrides, qos=qos):
            self.get_logger().warning(f"ignored: {sentence}")

    def start(self) -> None:
        """Configure and activate.

        Raises
        ------
        InputError
            With the reason, if one of the two failed.
        """
        for trigger in (self.trigger_configure, self.trigger_activate):
            # rclpy swallows the exception of a callback; `failure` has kept its reason.
            if trigger() != TransitionCallbackReturn.SUCCESS:
                raise InputError(self.failure)

    def destroy_node(self) -> None:
        """Destroy the node and its state machine, without which it would stay in the graph."""
        super().destroy_node()
        rclpy_internals.destroy_state_machine(self)

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """See `configure`."""
        return self._transit(self.configure, partial(super().on_configure, state))

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """See `activate`; publishers speak first."""
        return self._transit(partial(super().on_activate, state), self.activate)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """See `deactivate`; publishers fall silent last."""
        return self._transit(self.deactivate, partial(super().on_deactivate, state))

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """See `cleanup`."""
        return self._transit(self.cleanup, partial(super().on_cleanup, state))

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Let go of everything, whatever the state was."""
        return self._transit(self.deactivate, self.cleanup, partial(super().on_shutdown, state))

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Let go of everything, to be configured anew."""
        return self._transit(self.deactivate, self.cleanup, partial(super().on_error, state))

    def _transit(self, *steps: Callable[[], object]) -> TransitionCallbackReturn:
        try:
            for step in steps:
                step()
        except InputError as error:
            self.failure = str(error)
            return TransitionCallbackReturn.FAILURE
        except Exception as error:
            self.failure = f"unexpected {type(error).__name__}: {error}"
            if self.context.ok():  # otherwise a signal took the ground from under a call
                self.get_logger().error(f"in a transition: {traceback.format_exc()}")
            return TransitionCallbackReturn.ERROR
        return TransitionCallbackReturn.SUCCESS

    def _answer_change_state(
        self, answer: Callable[..., Any], request: ChangeState.Request, response: Any
    ) -> ChangeState.Response:
        label = rclpy_internals.state_label(self)
        state_id = request.transition.id
        wanted = request.transition.label or str(state_id)
        before = self.failure
        # rclpy raises before it calls one of ours where there is none: this stands until one says
        # more.
        self.failure = "there is no such transition"
        try:
            response = answer(request, response)
        except rclpy_internals.RCLError:
            response.success = False
        if not response.success:
            self.get_logger().error(f"transition {wanted} from {label} failed: {self.failure}")
        else:
            self.failure = before
        return response
