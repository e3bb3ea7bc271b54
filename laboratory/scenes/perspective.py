# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Vehicles on the plane of the road, drawn as a camera sees them in perspective.

Coordinates in metres: x to the right, y ahead, z up. Edges between projected corners are straight,
also where the lens bends them: over a vehicle that is a fraction of a pixel.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.road.lens import Lens
from vehicle_pf_tracker.road.plane import RoadPlane
from vehicle_pf_tracker.road.poses import Pose
from vehicle_pf_tracker.scenes.compositing import Sprite
from vehicle_pf_tracker.scenes.polygons import cells_inside
from vehicle_pf_tracker.scenes.scene import Actor
from vehicle_pf_tracker.scenes.solids import SAME_PLACE, SHADOW_OPACITY, Face, lit, shadow
from vehicle_pf_tracker.scenes.turning_vehicle import all_round, turned
from vehicle_pf_tracker.scenes.vehicle_parts import TYRE

_OVERSAMPLING = 4
"""Cells drawn per pixel and axis; a frame draws every vehicle anew, at its own distance."""
_MOST_CELLS = 500_000
"""The default of `RoadCamera.most_cells`: more than an image of 640x480 has pixels."""
_TREAD = 0.2
"""Width of a tyre, m: that of common cars."""

Drive = Callable[[float], tuple[float, float]]
"""Gives the position (x, y; m) on the road of a vehicle's middle at a frame number."""


@dataclass(frozen=True, slots=True, eq=False)
class RoadCamera:
    """Camera over a road.

    Attributes
    ----------
    lens : Lens
        Focal lengths, principal point and distortion.
    pose : Pose
        Pose of its optical frame in the road's.
    most_cells : int
        Cells of a vehicle beyond which it is drawn more coarsely.
    """

    lens: Lens
    pose: Pose
    most_cells: int = _MOST_CELLS

    @property
    def plane(self) -> RoadPlane:
        """Exact map from its pixels to the road."""
        return RoadPlane.of_camera(self.lens, self.pose, coarsest=math.inf)

    def depth(self, points: Array) -> Array:
        """Return the distance (…,) along the view of points (…, 3), m."""
        # The columns of the rotation are the camera's axes in the road's: right, down, ahead.
        depth: Array = (points - self.pose.position) @ self.pose.rotation[:, 2]
        return depth

    def project(self, points: Array) -> Array:
        """Return the pixels (…, 2) of points (…, 3) in front of the camera."""
        local = (points - self.pose.position) @ self.pose.rotation
        ideal = local[..., :2] / local[..., 2:] * self.lens.focal + self.lens.matrix[:2, 2]
        return self.lens.to_pixels(ideal)


def looking(position: tuple[float, float, float], at: tuple[float, float]) -> Pose:
    """Return the pose of a camera at `position` that looks level at the road point `at`."""
    place = np.asarray(position)
    view = np.array([*at, 0.0]) - place
    view /= np.linalg.norm(view)
    # Level: the right axis is on the ground's plane.
    right = np.cross(view, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    return Pose(np.column_stack([right, np.cross(view, right), view]), place)


class RoadVehicle:
    """A vehicle on the road.

    Parameters
    ----------
    faces : sequence of Face
        The vehicle as seen from its near side.
    axles : sequence of float
        Places of the axles along it, m from its rear.
    heading : float
        Direction it drives to: 0 along x, pi/2 along y, rad.
    drive : Drive
        Way of the vehicle.
    camera : RoadCamera
        Camera that sees it.
    """

    def __init__(
        self,
        faces: Sequence[Face],
        axles: Sequence[float],
        heading: float,
        drive: Drive,
        camera: RoadCamera,
    ) -> None:
        body = [*all_round(faces), *_treads(faces, axles)]
        self._body = _Solid(turned(body, heading))
        self._shadow = _Solid(shadow(turned(body, heading)))
        self._drive = drive
        self._camera = camera
        self._drawn: dict[bool, tuple[float, Sprite]] = {}

    def actors(self) -> tuple[Actor, Actor]:
        """Return shadow and body, in the order to paint them."""
        return self._actor(shade=True), self._actor(shade=False)

    def _actor(self, *, shade: bool) -> Actor:
        def look(frame: float) -> Sprite:
            # Kept for the frame: who asks for the picture and for what it hides has it drawn once.
            last = self._drawn.get(shade)
            if last is None or last[0] != frame:
                opacity = SHADOW_OPACITY if shade else 1.0
                last = frame, draw(self._placed(frame, shade=shade), self._camera, opacity)
                self._drawn[shade] = last
            return last[1]

        def path(frame: float) -> Box:
            corners, _ = self._placed(frame, shade=shade)
            return bounds(self._camera.project(corners))

        return Actor(look, path, hides=not shade)

    def _placed(self, frame: float, *, shade: bool) -> tuple[Array, _Solid]:
        solid = self._shadow if shade else self._body
        return solid.corners + np.array([*self._drive(frame), 0.0]), solid


class _Solid:
    """Faces with all of their corners in one array."""

    def __init__(self, faces: Sequence[Face]) -> None:
        self.faces = faces
        self.corners = np.concatenate([np.asarray(face.points) for face in faces])
        ends = np.cumsum([len(face.points) for face in faces]).tolist()
        self.slices = [
            slice(end - len(face.points), end) for face, end in zip(faces, ends, strict=True)
        ]


def _treads(faces: Sequence[Face], axles: Sequence[float]) -> list[Face]:
    """Make the four tyres as seen from before and behind, where discs have no width."""
    x = [point[0] for face in faces for point in face.points]
    width = max(point[1] for face in faces for point in face.points)
    middle = (min(x) + max(x)) / 2
    radius = 0.36
    return [
        Face(
            tuple(
                # Before and behind the axle, where the tread is seen, and half the tyre's height.
                (axle - middle + side * radius * 0.6, left - width / 2 + across, up)
                for across, up in ((0, 0.0), (_TREAD, 0.0), (_TREAD, radius), (0, radius))
            ),
            TYRE,
            glow=True,
        )
        for axle in axles
        for left in (0.0, width - _TREAD)
        for side in (-1, 1)
    ]


def bounds(points: Array) -> Box:
    """Return the tight box around points (N, 2), px."""
    left, top = points.min(axis=0).tolist()
    right, bottom = points.max(axis=0).tolist()
    return Box(left, top, right - left, bottom - top)


def draw(placed: tuple[Array, _Solid], camera: RoadCamera, opacity: float) -> Sprite:
    """Draw a solid where it stands: the nearest face is seen, and of two in one place the later.

    Parameters
    ----------
    placed : (N, 3) array and _Solid
        Corners of the faces on the road, m, and the faces.
    camera : RoadCamera
        Camera that sees it.
    opacity : float
        Opacity of its faces, 0 to 1.
    """
    corners, solid = placed
    pixels = camera.project(corners)
    box = bounds(pixels)
    # A vehicle beside the camera would have millions of cells; it is drawn more coarsely.
    fineness = min(_OVERSAMPLING, math.sqrt(camera.most_cells / box.area))
    columns = math.ceil(box.width * fineness)
    rows = math.ceil(box.height * fineness)
    cells = (pixels - (box.x, box.y)) * (columns / box.width, rows / box.height)
    # Inverse depth, as it is linear across a face in the image; depth itself is not.
    nearness = 1 / camera.depth(corners)
    colour = np.zeros((rows, columns, 3), np.uint8)
    # 0 is infinitely far: nothing there yet.
    nearest = np.zeros((rows, columns))
    for face, part in zip(solid.faces, solid.slices, strict=True):
        window, inside = cells_inside(cells[part], rows, columns)
        if inside.any():
            near = _over(cells[part], nearness[part], window.left, window.top, inside.shape)
            kept = nearest[window.slices]
            # A depth buffer: no order of the faces is right from every side. Those in one place, as
            # a window in its wall, are told apart by their order.
            # kept / (1 + s kept) = 1 / (1 / kept + s): s metres behind what is there.
            inside &= near > kept / (1 + SAME_PLACE * kept)
            kept[inside] = near[inside]
            colour[window.slices][inside] = _shaded(face, corners[part], camera)
    return Sprite(colour, (nearest > 0) * opacity)


def _over(points: Array, values: Array, left: int, top: int, shape: tuple[int, ...]) -> Array:
    """Spread values at the corners of a face over cells: inverse depth is linear in the image."""
    # By least squares, as faces have three corners or many; for flat ones it is exact.
    design = np.column_stack([points, np.ones(len(points))])
    across, down, level = np.linalg.lstsq(design, values, rcond=None)[0]
    x = left + 0.5 + np.arange(shape[1])
    y = top + 0.5 + np.arange(shape[0])
    spread: Array = level + across * x + (down * y)[:, np.newaxis]
    return spread


def _shaded(face: Face, corners: Array, camera: RoadCamera) -> tuple[float, float, float]:
    if face.glow:
        return face.colour
    normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    normal = normal / np.linalg.norm(normal)
    # Light falls on the side that is seen, whichever way round the corners were given.
    seen_from_outside = normal @ (camera.pose.position - corners[0]) >= 0
    return lit(face.colour, normal if seen_from_outside else -normal)
