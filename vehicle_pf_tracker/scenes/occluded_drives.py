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

"""Scenes in which something hides the target: standing obstacles, or other vehicles close to it."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from vehicle_pf_tracker.parameters.table import parameter
from vehicle_pf_tracker.scenes.compositing import Image, overlap, stream
from vehicle_pf_tracker.scenes.drive import LANE, PAINTS, Drive, DriveParameters
from vehicle_pf_tracker.scenes.models import Model
from vehicle_pf_tracker.scenes.obstacles import bridge as make_bridge
from vehicle_pf_tracker.scenes.obstacles import pillar, post, sign, tree
from vehicle_pf_tracker.scenes.paths import Bend, Pace, Pose
from vehicle_pf_tracker.scenes.roads import convoy, side_road
from vehicle_pf_tracker.scenes.scene import Actor, Scene
from vehicle_pf_tracker.scenes.solids import ELEVATION
from vehicle_pf_tracker.scenes.vehicles import car, coach, saloon, suv, van


@dataclass(frozen=True, slots=True)
class HidingParameters(DriveParameters):
    """Parameters of scenes in which one obstacle hides the target."""

    hidden: float = parameter(
        15.0, "longer occlusions leave more to prediction",
        minimum=1.0, maximum=40.0, unit="frames",
    )  # fmt: skip


def hiding_width(drive: Drive, frames: float) -> float:
    """Width (px) of what hides the target wholly for about `frames` frames."""
    return drive.target.size[0] + frames * drive.parameters.speed


def bridge_at(drive: Drive, share: float, frames: float) -> list[Actor]:
    """Lead a bridge over the road that hides the target for `frames` frames."""
    width = hiding_width(drive, frames)
    left = drive.x(drive.along(share)) - width / 2
    return list(make_bridge(left, width, drive.height, stream(drive.seed, "bridge")))


def sign_at(drive: Drive, share: float, frames: float, name: str = "sign") -> list[Actor]:
    """Put up a road sign that hides the target for `frames` frames."""
    middle, width = drive.x(drive.along(share)), hiding_width(drive, frames)
    height = drive.target.size[1]
    board = width, drive.row - height - 12, drive.row + 0.4 * height + 8
    foot = drive.opposite.rows.stop + 22
    return sign(middle, board, foot, stream(drive.seed, name))


def pillar_at(drive: Drive, share: float, frames: float) -> list[Actor]:
    """Put up a pillar that hides the target for `frames` frames."""
    middle, width = drive.x(drive.along(share)), hiding_width(drive, frames)
    return pillar(middle, width, drive.height, stream(drive.seed, "pillar"))


def posts_at(drive: Drive, shares: tuple[float, ...], width: float = 9.0) -> list[Actor]:
    """Put up lamp posts, which hide a part of the target for a moment."""
    foot = drive.opposite.rows.stop + 14
    return [
        actor for share in shares for actor in post(drive.x(drive.along(share)), width, -5, foot)
    ]


def trees_at(drive: Drive, shares: tuple[float, ...], density: float = 0.36) -> list[Actor]:
    """Plant trees whose thin crowns hide a part of the target."""
    rng = stream(drive.seed, "trees")
    length, height = drive.target.size
    actors: list[Actor] = []
    for share in shares:
        top = drive.row - rng.uniform(0.9, 1.2) * height
        crown = rng.uniform(1.3, 1.8) * length, top, top + rng.uniform(75, 95)
        foot = drive.opposite.rows.stop + rng.uniform(8, 30)
        actors += tree(drive.x(drive.along(share)), crown, foot, density, rng)
    return actors


def bars(parameters: DriveParameters, seed: int) -> Scene:
    """Make the scene: four pillars of rising width; the last two hide the target wholly."""
    drive = Drive(parameters, seed)
    rng = stream(seed, "pillars")
    widths = 12.0, 0.7 * drive.target.size[0], hiding_width(drive, 4), hiding_width(drive, 10)
    places = 0.15, 0.22, 0.335, 0.65
    front = [
        actor
        for share, width in zip(places, widths, strict=True)
        for actor in pillar(drive.x(drive.along(share)), width, drive.height, rng)
    ]
    return drive.scene("bars", front)


def bridge(parameters: HidingParameters, seed: int) -> Scene:
    """Make the scene: a bridge across the road."""
    drive = Drive(parameters, seed)
    return drive.scene("bridge", bridge_at(drive, 0.5, parameters.hidden))


def signs(parameters: HidingParameters, seed: int) -> Scene:
    """Make the scene: lamp posts, and a large sign that hides the target."""
    drive = Drive(parameters, seed)
    front = [*posts_at(drive, (0.2, 0.82)), *sign_at(drive, 0.47, parameters.hidden)]
    return drive.scene("signs", front)


def trees(parameters: DriveParameters, seed: int) -> Scene:
    """Make the scene: trees along the road, each of which hides a part of the target."""
    drive = Drive(parameters, seed)
    return drive.scene("trees", trees_at(drive, (0.25, 0.43, 0.6, 0.78)))


COACH_LENGTH = 12.0
"""Metres."""
CLEAR_FRAMES = 10
"""Frames at the start in which nothing may hide the target: trackers learn it there."""


def coach_at(
    drive: Drive, share: float, frames: float, length: float = COACH_LENGTH
) -> list[Actor]:
    """Let a coach overtake in the nearer lane and hide the target for about `frames` frames.

    `length` is the coach's, in metres.
    """
    spare = length * drive.scale - drive.target.size[0]
    speed = drive.parameters.speed + spare / frames
    faces = coach((206, 204, 196), (34, 82, 128), length)
    return drive.meeting(faces, drive.along(share), speed)


def van_at(drive: Drive, share: float, frames: float) -> list[Actor]:
    """Let the target overtake a van in the nearer lane, half hidden by it for about `frames`."""
    faces = van((196, 196, 190))
    length = Model(faces, drive.scale).size[0]
    speed = drive.parameters.speed - (length + drive.target.size[0]) / frames
    return drive.meeting(faces, drive.along(share), speed)


def near_traffic(drive: Drive) -> list[Actor]:
    """Fill the nearer lane with faster vehicles, each of which hides a part of the target."""
    rng = stream(drive.seed, "near lane")
    speed = drive.parameters.speed * rng.uniform(1.5, 1.7)
    lane = drive.road.lane(LANE + 1)
    others = convoy(lane, speed, drive.frame_count, drive.width, rng, (40, 130), (van,))
    return _clear_at_first(drive, others)


def _clear_at_first(drive: Drive, others: list[Actor]) -> list[Actor]:
    """Leave out the vehicles that would hide the target before it has been seen for a while."""
    own = drive.target.on(drive.course(drive.start, drive.pace))[1]
    return [
        actor
        for pair in zip(others[::2], others[1::2], strict=True)
        if not any(overlap(pair[1].path(frame), own.path(frame)) for frame in range(CLEAR_FRAMES))
        for actor in pair
    ]


def bus(parameters: HidingParameters, seed: int) -> Scene:
    """Make the scene: a coach overtakes and hides the target."""
    drive = Drive(parameters, seed)
    return drive.scene("bus", coach_at(drive, 0.45, parameters.hidden))


def twin(parameters: DriveParameters, seed: int) -> Scene:
    """Make the scene: a vehicle of the same make and colour overtakes slowly in the far lane."""
    drive = Drive(parameters, seed)
    other = drive.meeting(drive.faces, drive.along(0.5), 1.1 * parameters.speed, lane=LANE - 1)
    return drive.scene("twin", drive.opposite_traffic(), behind=other)


def dense(parameters: DriveParameters, seed: int) -> Scene:
    """Make the scene: full lanes, of which the nearer one hides parts of the target."""
    drive = Drive(parameters, seed)
    rng = stream(seed, "dense")
    slow, fast = parameters.speed * rng.uniform(0.7, 0.8), parameters.speed * rng.uniform(1.3, 1.5)
    stage, gaps = (drive.frame_count, drive.width), (14, 60)
    far = convoy(drive.road.lane(LANE - 1), slow, *stage, rng, gaps)
    near = convoy(drive.road.lane(LANE + 1), fast, *stage, rng, gaps, (van, suv))
    ahead = _own_lane(drive, rng)
    return drive.scene(
        "dense", [*_clear_at_first(drive, near), *drive.opposite_traffic()], behind=[*far, *ahead]
    )


def _own_lane(drive: Drive, rng: np.random.Generator) -> list[Actor]:
    """Make the vehicles before and behind the target in its own lane, as fast as it is."""
    actors: list[Actor] = []
    for distance in (-200.0, -100.0, 100.0, 200.0):
        faces = (car, saloon)[rng.integers(2)](PAINTS[rng.integers(len(PAINTS))])
        place = drive.start + distance + rng.uniform(-15, 15)
        actors += Model(faces, drive.scale).on(drive.course(place, drive.pace))
    return actors


CROSSING = math.radians(28)
"""Angle between the road and the one that crosses it."""


def cross(parameters: DriveParameters, seed: int) -> Scene:
    """Make the scene: the target slows down for a coach that crosses the road before it."""
    base = Drive(parameters, seed)
    speed, slow = parameters.speed, 0.5 * parameters.speed
    brake = base.frame_at(base.along(0.33))
    pace = Pace(((0.0, speed), (brake, speed), (brake + 12, slow), (brake + 26, slow),
                 (brake + 38, speed)))  # fmt: skip
    drive = Drive(parameters, seed, pace)
    scene = drive.scene("cross", _crossing_coach(drive, brake + 22), behind=())
    return replace(scene, backdrop=lambda: _crossroads(drive, brake + 22))


def _crossing_coach(drive: Drive, frame: float) -> list[Actor]:
    """Make the coach whose middle is right in front of the target in `frame`."""
    x, y = _crossing(drive, frame)
    heading = CROSSING - math.pi if drive.rightward else -CROSSING
    pace = Pace(((frame, 0.9 * drive.parameters.speed),))
    model = Model(coach((190, 60, 48), (230, 226, 216)), drive.scale)
    return list(model.on(Bend(Pose(x, y, heading, drive.scale), pace)))


def _crossing(drive: Drive, frame: float) -> tuple[float, float]:
    """Place of the coach's middle in `frame`: a little nearer to the viewer than the target's."""
    target = drive.course(drive.start, drive.pace)(frame)
    return target.x, target.y + 18


def _crossroads(drive: Drive, frame: float) -> Image:
    picture = drive.backdrop()
    x, y = _crossing(drive, frame)
    slope = math.tan(CROSSING) * math.sin(ELEVATION) * (-1 if drive.rightward else 1)
    top, bottom = -1.0, drive.height + 1.0
    ends = (x + (top - y) / slope, top), (x + (bottom - y) / slope, bottom)
    side_road(
        picture, *ends, 7.5 * drive.scale / math.sin(CROSSING), stream(drive.seed, "crossing")
    )
    return picture
