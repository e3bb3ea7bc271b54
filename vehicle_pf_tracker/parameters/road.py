# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Parameters of the mapping from pixels to the road, and their text: pairs, lens and pose."""

from __future__ import annotations

import re
from dataclasses import dataclass

from vehicle_pf_tracker.core.errors import InputError, brief
from vehicle_pf_tracker.parameters.table import parameter
from vehicle_pf_tracker.road.lens import LENS_MODELS, Lens
from vehicle_pf_tracker.road.plane import Pair, RoadPlane
from vehicle_pf_tracker.road.poses import Pose

_LARGEST_NUMBER = 1e7
"""Bound of every number: no image is as wide, and map coordinates (UTM) are below it."""


@dataclass(frozen=True, slots=True)
class RoadParameters:
    """Mapping from pixels to the road: by pairs of points, or by the camera's lens and pose.

    Lists of numbers are strings, because ROS reads a list of integers and reals as neither.
    """

    pairs: str = parameter(
        "", "Pixels and the road points that they show, `u,v=x,y; …` in px and m, at least four: "
        "positions and speeds are then given on the road too.",
    )  # fmt: skip
    intrinsics: str = parameter(
        "", "Focal lengths and principal point of the camera, `fx,fy,cx,cy` as in CameraInfo: "
        "needed to remove distortion, and for the road from the camera's pose.", unit="px",
    )  # fmt: skip
    distortion_model: str = parameter(
        "none", "Model of the lens's distortion, by its name in CameraInfo.", choices=LENS_MODELS
    )
    distortion: str = parameter(
        "", "Coefficients of the distortion, in the order of CameraInfo, apart by commas."
    )
    camera_pose: str = parameter(
        "", "Pose of the camera's optical frame in the road's, `x,y,z,qx,qy,qz,qw`: without "
        "pairs, the road is the plane z = 0 there.", unit="m",
    )  # fmt: skip
    from_camera_info: bool = parameter(
        False, "Nodes: take the lens from the topic camera_info beside the images."
    )
    from_tf: bool = parameter(
        False, "Nodes: take the camera's pose from TF, from road.frame_id to the images' frame."
    )
    rectified: bool = parameter(
        False, "Images are rectified: camera_info's projection matrix counts, without distortion."
    )
    frame_id: str = parameter(
        "road", "Frame that positions on the road are published in; its z = 0 is the road."
    )
    margin: float = parameter(
        0.1, "Larger: positions are also given farther outside the hull of the pairs.",
        bounds=(0.0, 10.0), unit="share of its size",
    )  # fmt: skip
    coarsest: float = parameter(
        1.0, "Larger: positions are also given farther away, where a pixel is so long on the road.",
        bounds=(0.001, 1000.0), unit="m",
    )  # fmt: skip
    acceleration: float = parameter(
        0.5, "Larger: the speed follows braking faster, and is less steady.", bounds=(0.01, 100.0),
        unit="m/s per second",
    )  # fmt: skip

    @property
    def is_set(self) -> bool:
        """True where a mapping is asked for."""
        return bool(self.parsed_pairs or self.camera_pose or self.from_tf)

    @property
    def parsed_pairs(self) -> tuple[Pair, ...]:
        """Pairs as points."""
        return parse_pairs(self.pairs)

    @property
    def lens(self) -> Lens | None:
        """Lens by the parameters; None where they give none."""
        numbers = parse_numbers(self.intrinsics, "road.intrinsics")
        coefficients = parse_numbers(self.distortion, "road.distortion")
        if coefficients and not numbers:
            raise InputError("road.distortion needs road.intrinsics (fx,fy,cx,cy) beside it")
        if len(numbers) not in (0, 4):
            raise InputError(
                f"road.intrinsics must be fx,fy,cx,cy in px, got {brief(self.intrinsics)}"
            )
        if not numbers:
            return None
        fx, fy, cx, cy = numbers
        return Lens((fx, fy), (cx, cy), self.distortion_model, coefficients)

    @property
    def pose(self) -> Pose | None:
        """Pose of the camera by the parameters; None where they give none."""
        numbers = parse_numbers(self.camera_pose, "road.camera_pose")
        if len(numbers) not in (0, 7):
            raise InputError(
                "road.camera_pose must be x,y,z,qx,qy,qz,qw (m, unit), "
                f"got {brief(self.camera_pose)}"
            )
        return Pose.of(numbers[:3], numbers[3:]) if numbers else None

    def plane(self, lens: Lens | None, pose: Pose | None) -> RoadPlane:
        """Make the plane of the pairs, else of the camera.

        Raises
        ------
        InputError
            If the pairs do not determine it, or lens or pose are missing.
        """
        pairs = self.parsed_pairs
        if pairs:
            return RoadPlane.of_pairs(pairs, lens, margin=self.margin, coarsest=self.coarsest)
        if lens is None or pose is None:
            raise InputError("the road of a camera needs both its lens and its pose")
        return RoadPlane.of_camera(lens, pose, coarsest=self.coarsest)

    def fixed_plane(self) -> RoadPlane | None:
        """Make the plane of the parameters alone; None where no road is set.

        Raises
        ------
        InputError
            If lens or pose are to come from topics.
        """
        if self.is_set and (self.from_camera_info or self.from_tf):
            raise InputError(
                "road.from_camera_info and road.from_tf are for nodes of one vehicle; here "
                "give road.intrinsics, road.distortion and road.camera_pose"
            )
        return self.plane(self.lens, self.pose) if self.is_set else None

    def validate(self) -> None:
        """Refuse what makes no road, as far as it does not wait for CameraInfo or TF."""
        lens = self.lens
        pose = self.pose
        problem = self._problem()
        if problem:
            raise InputError(problem)
        if self.parsed_pairs:
            self.plane(lens, None)
        elif pose is not None and lens is not None:
            self.plane(lens, pose)

    def _problem(self) -> str:
        """Say which parameters contradict each other, or lack another one."""
        by_pose = bool(self.camera_pose.strip() or self.from_tf)
        by_pairs = bool(self.pairs.strip())
        has_lens = bool(self.intrinsics.strip() or self.from_camera_info)
        rules = {
            "give either road.pairs or the camera's pose, not both": by_pairs and by_pose,
            "give either road.camera_pose or road.from_tf, not both": (
                bool(self.camera_pose.strip()) and self.from_tf
            ),
            "give either road.intrinsics or road.from_camera_info, not both": (
                bool(self.intrinsics.strip()) and self.from_camera_info
            ),
            "the camera's pose needs its lens beside it: road.intrinsics (fx,fy,cx,cy), or in a "
            "node road.from_camera_info": by_pose and not has_lens,
            "road.frame_id must name the frame of the road": not self.frame_id,
        }
        return next((words for words, broken in rules.items() if broken), "")


def parse_pairs(text: str) -> tuple[Pair, ...]:
    """Read pairs ``u,v=x,y`` in px and m, apart by semicolons or spaces.

    Raises
    ------
    InputError
        If one is not of this form.
    """
    return tuple(_pair(word) for word in re.split(r"[;\s]+", text.strip()) if word)


def _pair(word: str) -> Pair:
    sides = [parse_numbers(side, f"the pair {brief(word)} of the road") for side in word.split("=")]
    if [len(numbers) for numbers in sides] != [2, 2]:
        raise InputError(f"the pair {brief(word)} of the road is not u,v=x,y (pixels = metres)")
    (u, v), (x, y) = sides
    return Pair((u, v), (x, y))


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
        raise InputError(f"{name} must be numbers apart by commas, got {brief(text)}") from None
    if not all(abs(number) <= _LARGEST_NUMBER for number in numbers):
        raise InputError(
            f"{name} has a number that is not finite or above {_LARGEST_NUMBER:g}: {brief(text)}"
        )
    return numbers
