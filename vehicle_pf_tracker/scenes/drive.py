# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A vehicle drives along a road from one side of the image to the other, as in most scenes."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.parameters.table import parameter
from vehicle_pf_tracker.scenes.cameras import DISTURBANCES, SHAKE_MARGIN, OutdoorCamera
from vehicle_pf_tracker.scenes.compositing import Colour, Image
from vehicle_pf_tracker.scenes.courses import (
    Course,
    Pace,
    Pose,
    straight,
    swaying,
    wave,
)
from vehicle_pf_tracker.scenes.lane_traffic import Stage, convoy
from vehicle_pf_tracker.scenes.random_streams import stream
from vehicle_pf_tracker.scenes.roads import Carriageway, countryside, town
from vehicle_pf_tracker.scenes.scene import Actor, Scene, stamps_parameter
from vehicle_pf_tracker.scenes.solids import Face
from vehicle_pf_tracker.scenes.turning_vehicle import TurningVehicle
from vehicle_pf_tracker.scenes.vehicles import car, suv, truck

PAPER_SIZES = {"640x480": (640, 480), "768x576": (768, 576)}
"""Width and height in px of the papers' videos, by the word that the parameter takes."""
FREE_PX = 10
"""Free pixels between the vehicle and the image's sides in the first and the last frame."""
TARGET_LANE = 1
"""The target's lane, counted from the far side; there is one farther and one nearer."""

TARGET_PAINTS: tuple[Colour, ...] = (
    (176, 180, 184),
    (58, 62, 68),
    (214, 212, 204),
    (44, 78, 134),
    (148, 40, 40),
    (62, 96, 70),
    (178, 162, 124),
    (104, 50, 58),
    (120, 136, 150),
    (196, 150, 52),
)
"""Colours of the target, by chance: most as muted as those of real traffic."""


@dataclass(frozen=True, slots=True)
class DriveParameters:
    """Parameters of every drive."""

    speed: float = parameter(
        5.0, "faster vehicles need a wider search, and the video gets shorter",
        bounds=(2.0, 20.0), unit="px/frame",
    )  # fmt: skip
    vehicle: str = parameter(
        "car", "the kind of vehicle that is followed: larger ones fill more of the image",
        choices=("car", "suv", "truck"), source="Scharcanski 2011, table I",
    )  # fmt: skip
    heading: str = parameter("right", "the side the vehicle drives to", choices=("right", "left"))
    surroundings: str = parameter(
        "country", "meadows and hedges, or pavements beside the road", choices=("country", "town")
    )
    resolution: str = parameter(
        "640x480", "larger images show vehicles a little larger, for longer", choices=PAPER_SIZES,
        unit="px", source="Scharcanski 2011, table I",
    )  # fmt: skip
    disturbance: str = parameter(
        "clean", "rough shakes the camera, flickers and adds noise", choices=DISTURBANCES
    )
    frame_rate: float = stamps_parameter(15.0, "speed is", "Scharcanski 2011, section IV")


class Drive:
    """A target on its way, and the means to put things around it.

    Places along the way are given by `s`: px from the side of the stage the target comes from.

    Parameters
    ----------
    parameters : DriveParameters
        Parameters of the drive.
    seed : int
        Seed of the scene.
    pace : Pace or None
        The target's speed over time, from frame 0; None keeps the speed chosen.
    """

    def __init__(self, parameters: DriveParameters, seed: int, pace: Pace | None = None) -> None:
        self.parameters = parameters
        self.seed = seed
        self.image_size = PAPER_SIZES[parameters.resolution]
        self.width, self.height = (size + 2 * SHAKE_MARGIN for size in self.image_size)
        self.road, self.opposite = self._roads()
        # Drawn in a fixed order below: another number here would change every scene.
        self.rng = stream(seed, "drive")
        self.faces = target_faces(parameters.vehicle, self.rng)
        self.target = TurningVehicle(self.faces, self.scale)
        # At least 2 px beside the free ones: the driver sways by up to 1.5 px along the road.
        self.start = SHAKE_MARGIN + FREE_PX + self.target.size[0] / 2 + self.rng.uniform(2, 6)
        self.pace = pace or Pace.steady(parameters.speed)

    @property
    def rightward(self) -> bool:
        """True where the target drives to the right."""
        return self.parameters.heading == "right"

    @property
    def scale(self) -> float:
        """Size of the vehicles, px per metre."""
        return self.road.scale

    @property
    def frame_count(self) -> int:
        """Number of frames until the target gets near the edge of the image it leaves by."""
        return int(self.frame_at(self._end)) + 1

    @property
    def stage(self) -> Stage:
        """Number of frames and width of the scene."""
        return Stage(self.frame_count, self.width)

    @property
    def _end(self) -> float:
        """Place of the target's middle in the last frame; another where the drive has a turn."""
        return self.width - SHAKE_MARGIN - FREE_PX - self.target.size[0] / 2 - 2

    @property
    def row(self) -> float:
        """Row of the ground under the target's middle."""
        return self.road.middle(TARGET_LANE)

    def x(self, s: float) -> float:
        """Column of the place `s`."""
        return s if self.rightward else self.width - s

    def along(self, share: float) -> float:
        """Place at a share of the image's width: 0 where the target enters, 1 where it leaves."""
        return SHAKE_MARGIN + share * self.image_size[0]

    def frame_at(self, s: float) -> float:
        """Frame in which the target's middle is at `s`, but for the driver's swaying."""
        return self.pace.arrival(s - self.start)

    def course(self, s: float, pace: Pace, lane: int = TARGET_LANE) -> Course:
        """Make the course along `lane` of a vehicle whose middle is at `s` when `pace` starts."""
        heading = 0.0 if self.rightward else math.pi
        return straight(Pose(self.x(s), self.road.middle(lane), heading, self.scale), pace)

    def sways(self, course: Course) -> Course:
        """Add a human hand to a course: at most 1.5 px along the road and 0.5 across."""
        # Periods of 90 and 130 frames: slow against an occlusion (40 frames at most), so that the
        # swing bends the path a little but does not show as a turn behind the obstacle.
        phases = stream(self.seed, "sway").uniform(0, 2 * math.pi, 2).tolist()
        return swaying(course, wave(1.5, 90, phases[0]), wave(0.5, 130, phases[1]))

    def meeting(
        self, faces: Sequence[Face], s: float, speed: float, lane: int = TARGET_LANE + 1
    ) -> list[Actor]:
        """Make a vehicle level with the target when that is at `s`; `speed` in px/frame."""
        # A pace has covered 0 px at its first knot and less before: level in just that frame.
        pace = Pace(((self.frame_at(s), speed),))
        return list(TurningVehicle(faces, self.scale).on(self.course(s, pace, lane)))

    def far_traffic(self) -> list[Actor]:
        """Make the traffic of the far lane, behind the target."""
        # Slower than the target, which so passes vehicles of its own kind: distractors.
        speed = self.parameters.speed * self.rng.uniform(0.75, 0.85)
        return convoy(self.road.lane(0), speed, self.stage, self.rng)

    def opposite_traffic(self) -> list[Actor]:
        """Make the traffic of the other carriageway, which never hides the target."""
        speeds = self.rng.uniform(4.5, 8.5, self.opposite.lanes).tolist()
        return [
            actor
            for number, speed in enumerate(speeds)
            for actor in convoy(self.opposite.lane(number), speed, self.stage, self.rng)
        ]

    def backdrop(self) -> Image:
        """Draw the empty road in its surroundings."""
        return self._ground((self.road, self.opposite), stream(self.seed, "backdrop"))

    def _ground(self, roads: Sequence[Carriageway], rng: np.random.Generator) -> Image:
        draw = town if self.parameters.surroundings == "town" else countryside
        return draw((self.height, self.width), roads, rng)

    def scene(self, front: Iterable[Actor] = (), *, behind: Iterable[Actor] | None = None) -> Scene:
        """Make the scene: the target between what is `behind` it and what is in `front` of it.

        The traffic of the far lane is behind if nothing is said, and that of the other carriageway
        in front, but under what `front` has.
        """
        if behind is None:
            # Drawn before the opposite traffic: both take from `rng`, in this order.
            behind = self.far_traffic()
            front = (*self.opposite_traffic(), *front)
        # The order to paint in: what is nearer to the viewer comes later, and covers.
        behind = list(behind)
        own = self.target.on(self.sways(self.course(self.start, self.pace)))
        return Scene(
            width=self.image_size[0],
            height=self.image_size[1],
            frame_rate=self.parameters.frame_rate,
            frame_count=self.frame_count,
            backdrop=self.backdrop,
            actors=(*behind, *own, *front),
            # `own` is the shadow and then the body; the truth is that of the body.
            target=len(behind) + 1,
            camera=OutdoorCamera(DISTURBANCES[self.parameters.disturbance], self.seed),
        )

    def _roads(self) -> tuple[Carriageway, Carriageway]:
        # Larger images show vehicles a little larger, not more of the road.
        # A car of 3.7 m is 43 or 46 px long.
        scale = 11.5 if self.image_size[0] == 640 else 12.5
        # A third of the way down: room for the hedge above, and below for the other carriageway.
        road = Carriageway(round(0.34 * self.height), 3, scale, self.rightward)
        # 30 rows between the roads: the guard rail of `countryside` has 12 with its shadow.
        other = Carriageway(road.rows.stop + 30, 2, scale, not self.rightward)
        return road, other


def target_faces(kind: str, rng: np.random.Generator) -> list[Face]:
    """Make a vehicle of a `kind` of `DriveParameters.vehicle`, its colour left to chance."""
    # Drawn before the kind is asked: every kind has the same colour at the same seed.
    paint = TARGET_PAINTS[rng.integers(len(TARGET_PAINTS))]
    if kind == "truck":
        return truck(paint, (216, 214, 206))
    return suv(paint) if kind == "suv" else car(paint)
