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

"""Calibration as text: pairs, lens and pose as parameters give them."""

from __future__ import annotations

import re

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.road.camera import Lens, Pose
from vehicle_pf_tracker.road.plane import Pair

_LARGEST = 1e7
"""Bound of every number: no image is as wide, and map coordinates (UTM) are below it."""


def parse_pairs(text: str) -> tuple[Pair, ...]:
    """Read pairs ``u,v=x,y`` in px and m, apart by semicolons or spaces.

    Raises
    ------
    InputError
        If one is not of this form.
    """
    return tuple(_pair(word) for word in re.split(r"[;\s]+", text.strip()) if word)


def _pair(word: str) -> Pair:
    pixel, equals, road = word.partition("=")
    if not equals:
        raise InputError(f"the pair {word!r} of the road is not u,v=x,y (pixels = metres)")
    return Pair(_point(pixel, word), _point(road, word))


def _point(text: str, word: str) -> tuple[float, float]:
    numbers = parse_numbers(text, f"the pair {word!r} of the road")
    if len(numbers) != 2:
        raise InputError(f"the pair {word!r} of the road is not u,v=x,y (pixels = metres)")
    return numbers[0], numbers[1]


def format_pairs(pairs: tuple[Pair, ...]) -> str:
    """Write pairs so that `parse_pairs` reads them back to the last digit."""
    return "; ".join(
        ",".join(map(repr, pair.pixel)) + "=" + ",".join(map(repr, pair.road)) for pair in pairs
    )


def parse_numbers(text: str, name: str) -> tuple[float, ...]:
    """Read numbers apart by commas; none of an empty text.

    Raises
    ------
    InputError
        If one is not a number of a sensible size.
    """
    try:
        numbers = tuple(float(word) for word in text.split(",")) if text.strip() else ()
    except ValueError:
        raise InputError(f"{name} must be numbers apart by commas, got {text!r}") from None
    if not all(abs(number) <= _LARGEST for number in numbers):
        raise InputError(f"{name} has a number that is not finite or above {_LARGEST:g}: {text!r}")
    return numbers


def parse_lens(intrinsics: str, model: str, distortion: str) -> Lens | None:
    """Make the lens of ``fx,fy,cx,cy``, a model's name and its coefficients; None without them.

    Raises
    ------
    InputError
        If the numbers do not make a lens.
    """
    numbers = parse_numbers(intrinsics, "road.intrinsics")
    coefficients = parse_numbers(distortion, "road.distortion")
    if not numbers:
        if coefficients:
            raise InputError("road.distortion needs road.intrinsics (fx,fy,cx,cy) beside it")
        return None
    if len(numbers) != 4:
        raise InputError(f"road.intrinsics must be fx,fy,cx,cy in px, got {intrinsics!r}")
    fx, fy, cx, cy = numbers
    return Lens((fx, fy), (cx, cy), model, coefficients)


def parse_pose(text: str) -> Pose | None:
    """Make the pose of ``x,y,z,qx,qy,qz,qw``; None of an empty text.

    Raises
    ------
    InputError
        If the numbers do not make a pose.
    """
    numbers = parse_numbers(text, "road.camera_pose")
    if not numbers:
        return None
    if len(numbers) != 7:
        raise InputError(f"road.camera_pose must be x,y,z,qx,qy,qz,qw (m, unit), got {text!r}")
    return Pose.of(numbers[:3], numbers[3:])
