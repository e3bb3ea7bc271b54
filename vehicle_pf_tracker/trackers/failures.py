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

"""Unexpected errors of a tracker, and when it starts anew because of them."""

from __future__ import annotations

from vehicle_pf_tracker.core.errors import InputError


class TrackerError(Exception):
    """Unexpected error of a tracker in one image; its cause is the error itself.

    Attributes
    ----------
    persists : bool
        True where the tracker failed again as soon as it had started anew: it is broken.
    """

    def __init__(self, error: Exception, *, persists: bool) -> None:
        super().__init__(unexpected(error))
        self.persists = persists


class Failures:
    """Number of unexpected errors of a tracker in a row, and what follows from each.

    The first one costs its image: it may be that image's fault. The second one has the tracker
    start anew and take the same image again. If that fails too, the tracker is broken.
    """

    def __init__(self) -> None:
        self._in_a_row = 0

    def clear(self) -> None:
        """Note that the tracker took an image."""
        self._in_a_row = 0

    def judge(self, error: Exception) -> str:
        """Return words for a new start; the caller then takes the same image again.

        Raises
        ------
        InputError
            If `error` is one: then the tracker is not at fault.
        TrackerError
            If the tracker is not to start anew for it.
        """
        if isinstance(error, InputError):
            raise error
        self._in_a_row += 1
        if self._in_a_row % 2:
            raise TrackerError(error, persists=self._in_a_row > 1) from error
        return f"the tracker failed twice in a row and has started anew: {unexpected(error)}"


def unexpected(error: Exception) -> str:
    """Describe an error that nobody expected."""
    if isinstance(error, TrackerError):
        return str(error)
    return f"unexpected {type(error).__name__}: {error}"
