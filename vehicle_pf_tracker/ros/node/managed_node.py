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

"""A managed node that says why a transition failed, and that no request can end.

rclpy swallows the exceptions of transition callbacks, and lets a transition that does not exist in
the present state end the process.
"""

from __future__ import annotations

import traceback
from abc import ABC, abstractmethod
from collections.abc import Callable
from functools import partial
from typing import Any

from lifecycle_msgs.srv import ChangeState
from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from rosgraph_msgs.msg import Clock

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.ros.rclpy_internals import (
    RCLError,
    change_state_service,
    destroy_state_machine,
    state_label,
)


class ManagedNode(LifecycleNode, ABC):  # type: ignore[misc]
    """Calls `configure`, `activate`, `deactivate` and `cleanup`, which raise where they fail.

    An `InputError` leaves the node in the state that it was in; any other exception takes it back
    to unconfigured. Each of the two that undo may be called in any state.

    Attributes
    ----------
    failure : str
        Reason of the last transition that failed; empty before one did.
    """

    def __init__(self, name: str, **options: Any) -> None:
        super().__init__(name, **options)
        self.failure = ""
        service = change_state_service(self)
        if service is not None:
            service.callback = partial(self._answer_change_state, service.callback)

    def create_subscription(
        self, kind: Any, topic: str, callback: Callable[..., Any], *args: Any, **options: Any
    ) -> Any:
        """Subscribe; that of rclpy to ``/clock`` passes over times that its clock cannot take."""
        if kind is Clock:
            callback = partial(self._take_clock, callback)
        return super().create_subscription(kind, topic, callback, *args, **options)

    def _take_clock(self, take: Callable[[Clock], object], message: Clock) -> None:
        if message.clock.sec < 0:
            words = f"/clock says {message.clock.sec} s, before time begins: passed over"
            self.get_logger().error(words, throttle_duration_sec=5.0)
        else:
            take(message)

    @abstractmethod
    def configure(self) -> None:
        """Make what an inactive node has."""

    @abstractmethod
    def activate(self) -> None:
        """Begin to listen."""

    @abstractmethod
    def deactivate(self) -> None:
        """Cease to listen."""

    @abstractmethod
    def cleanup(self) -> None:
        """Let go of what `configure` made."""

    def start(self) -> None:
        """Configure and activate.

        Raises
        ------
        InputError
            With the reason, if one of the two failed.
        """
        for trigger in (self.trigger_configure, self.trigger_activate):
            if trigger() != TransitionCallbackReturn.SUCCESS:
                raise InputError(self.failure)

    def destroy_node(self) -> None:
        """Destroy the node and its state machine, without which it would stay in the graph."""
        super().destroy_node()
        destroy_state_machine(self)

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
        self,
        answer: Callable[[ChangeState.Request, ChangeState.Response], ChangeState.Response],
        request: ChangeState.Request,
        response: ChangeState.Response,
    ) -> ChangeState.Response:
        label, state_id = state_label(self), request.transition.id
        wanted = request.transition.label or str(state_id)
        self.failure = "there is no such transition"
        try:
            response = answer(request, response)
        except RCLError:
            response.success = False
        if not response.success:
            self.get_logger().error(f"transition {wanted} from {label} failed: {self.failure}")
        return response
