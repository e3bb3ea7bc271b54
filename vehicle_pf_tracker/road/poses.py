# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Rigid transforms, and the tree that TF makes of them, without ROS."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.errors import InputError

_UNIT = 1e-2
"""Deviation of a quaternion's length from 1 that is taken as rounding of printed numbers."""


@dataclass(frozen=True, slots=True, eq=False)
class Pose:
    """Pose of a child frame in its parent: ``p_parent = rotation @ p_child + position``.

    Attributes
    ----------
    rotation : (3, 3) array
        Rotation whose columns are the child's axes in the parent.
    position : (3,) array
        The child's origin in the parent, m.
    """

    rotation: Array
    position: Array

    @classmethod
    def of(cls, position: tuple[float, ...], quaternion: tuple[float, ...]) -> Pose:
        """Make the pose of a position (x, y, z; m) and a quaternion (x, y, z, w).

        Raises
        ------
        InputError
            If a number is not finite, or the quaternion is not of length 1.
        """
        length = float(np.linalg.norm(quaternion))
        if not np.isfinite([*position, length]).all() or abs(length - 1) > _UNIT:
            raise InputError(
                f"the pose {position}, {quaternion} needs finite numbers and a quaternion x,y,z,w "
                "of length 1"
            )
        # Printed quaternions are rounded: scaled, the matrix is a rotation to the last digit.
        x, y, z, w = (number / length for number in quaternion)
        rotation = np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
            ]
        )
        return cls(rotation, np.asarray(position, np.float64))

    def __matmul__(self, other: Pose) -> Pose:
        return Pose(self.rotation @ other.rotation, self.rotation @ other.position + self.position)

    def equals(self, other: Pose | None) -> bool:
        """Return whether `other` is the same to the last digit."""
        return (
            other is not None
            and np.array_equal(self.rotation, other.rotation)
            and np.array_equal(self.position, other.position)
        )

    @property
    def inverse(self) -> Pose:
        """Pose of the parent in the child."""
        return Pose(self.rotation.T, -self.rotation.T @ self.position)


class PoseTree:
    """The newest pose of every frame in its parent, and of any frame in any other."""

    def __init__(self) -> None:
        self._parents: dict[str, tuple[str, Pose]] = {}

    def put(self, parent: str, child: str, pose: Pose) -> None:
        """Keep the pose of `child` in `parent`, over an earlier one."""
        # TF1 names began with a slash, and recordings of that time still have them.
        self._parents[child.lstrip("/")] = parent.lstrip("/"), pose

    def find(self, frame: str, reference: str) -> Pose:
        """Return the pose of `frame` in `reference`.

        Raises
        ------
        InputError
            If the two are not connected.
        """
        below = self._chain(frame.lstrip("/"))
        above = self._chain(reference.lstrip("/"))
        # The lowest common frame: both ways are multiplied up to there only.
        common = next((name for name in below if name in above), None)
        if common is None:
            raise InputError(f"TF does not connect the frames {frame!r} and {reference!r}")
        return above[common].inverse @ below[common]

    def _chain(self, frame: str) -> dict[str, Pose]:
        """Return the pose of `frame` in itself and in each frame above it, upwards."""
        pose = Pose(np.eye(3), np.zeros(3))
        chain = {frame: pose}
        while frame in self._parents:
            frame, step = self._parents[frame]
            if frame in chain:  # a loop, which TF forbids
                break
            pose = step @ pose
            chain[frame] = pose
        return chain
