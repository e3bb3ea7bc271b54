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

"""A window that shows frames, where OpenCV has any."""

from __future__ import annotations

import os

import cv2

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame


def has_display() -> bool:
    """Return whether windows can be shown."""
    return os.name != "posix" or bool(
        os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    )


class PictureWindow:
    """Shows one frame after the other.

    Parameters
    ----------
    title : str
        Title of the window.

    Raises
    ------
    InputError
        If there is no display, or this OpenCV has no windows.
    """

    def __init__(self, title: str) -> None:
        self._title = title
        try:
            # Without a display, Qt would end the program instead of raising.
            if not has_display():
                raise InputError("--show needs a display, and there is none; use --video FILE")
            cv2.namedWindow(title, cv2.WINDOW_NORMAL)
        except cv2.error:
            raise InputError(
                "--show needs an OpenCV with windows (opencv-python, not -headless); "
                "use --video FILE"
            ) from None

    def show(self, picture: Frame) -> bool:
        """Show a frame; False when the user presses q or Escape."""
        cv2.imshow(self._title, cv2.cvtColor(picture, cv2.COLOR_RGB2BGR))
        return cv2.waitKey(1) & 0xFF not in (ord("q"), 27)
