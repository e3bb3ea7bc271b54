"""Scenes after the second and the third paper: six cases, and four phases of one occlusion.

Sources: Abdulla et al., section V (cases 1 to 6); Khong et al., section VI (the phases before,
partially, fully and after occluded). The papers tell what happens; speeds are ours.
"""

from __future__ import annotations

import math

from reproduction.scenes.fixed_scenes import FixedScene, chosen, past
from vehicle_pf_tracker.core.truth import TOTAL_BELOW
from vehicle_pf_tracker.scenes.drive import LANE, RADIUS, Drive, DriveParameters
from vehicle_pf_tracker.scenes.light import tree_shadows
from vehicle_pf_tracker.scenes.manoeuvres import turning
from vehicle_pf_tracker.scenes.models import Model
from vehicle_pf_tracker.scenes.obstacles import tree
from vehicle_pf_tracker.scenes.occluded_drives import (
    coach_at,
    pillar_at,
    posts_at,
    trees_at,
    van_at,
)
from vehicle_pf_tracker.scenes.paths import Pace
from vehicle_pf_tracker.scenes.randomness import stream
from vehicle_pf_tracker.scenes.scene import Actor, Scene
from vehicle_pf_tracker.scenes.solids import ELEVATION, Face
from vehicle_pf_tracker.scenes.vehicles import coach, van

SHADE_DEPTH = 0.55
"""Share of the light that trees take away."""
BEFORE, PARTIAL, FULL = 40, 30, 20
"""Frames of the first three phases; the fourth is what remains of the way."""


def _turn_behind_trees(parameters: DriveParameters, seed: int) -> Scene:
    """Turn behind the thick crowns of two trees on the near side."""
    drive = turning(parameters, seed)
    rng = stream(seed, "trees")
    assert drive.corner is not None
    top = drive.row - RADIUS * math.sin(ELEVATION) - 1.1 * drive.target.size[1]
    foot = drive.road.rows.stop + 40
    front = [
        actor
        for share in (0.1, 0.9)
        for actor in tree(
            drive.x(drive.corner + share * RADIUS), (105, top, drive.row + 45), foot, 0.8, rng
        )
    ]
    return drive.scene("", front, behind=())


def _past_parked_vehicles(drive: Drive) -> list[Actor]:
    """Park a van that hides a part of the target, and a coach behind which it disappears."""
    length, speed = drive.target.size[0], drive.parameters.speed
    van_rear = drive.start + length / 2 + BEFORE * speed
    # Total begins and ends with a tenth of the vehicle in sight.
    coach_rear = van_rear + PARTIAL * speed - (1 - TOTAL_BELOW) * length
    coach_length = ((1 - 2 * TOTAL_BELOW) * length + FULL * speed) / drive.scale
    parked = (van((206, 206, 200)), van_rear), (
        coach((178, 60, 50), (226, 222, 210), coach_length), coach_rear
    )  # fmt: skip
    return [actor for faces, rear in parked for actor in _parked(drive, faces, rear)]


def _parked(drive: Drive, faces: list[Face], rear: float) -> tuple[Actor, Actor]:
    """Park a vehicle in the nearer lane, its rear at a place along the way."""
    model = Model(faces, drive.scale)
    return model.on(drive.course(rear + model.size[0] / 2, Pace.steady(0.0), LANE + 1))


_TABLE = (
    FixedScene("case1", "partial", "trees hide parts of the vehicle",
               chosen("car", 4.0, "right", {}),
               past(lambda d: trees_at(d, (0.27, 0.45, 0.62, 0.8), 0.42))),
    FixedScene("case2", "partial", "it overtakes a van that hides its lower half for long",
               chosen("car", 4.5, "right", {}), past(lambda d: van_at(d, 0.5, 60))),
    FixedScene("case3", "none", "trees cast shadows on the road and the vehicle",
               chosen("car", 4.0, "left", {"surroundings": "town"}),
               past(lambda d: tree_shadows(d, (0.2, 0.32, 0.47, 0.6, 0.74, 0.9), SHADE_DEPTH))),
    FixedScene("case4", "total", "a coach alongside hides it for 70 frames",
               chosen("car", 3.4, "right", {}), past(lambda d: coach_at(d, 0.46, 64, 15.0))),
    FixedScene("case5", "partial and total", "shadows, a post, and two pillars that hide it",
               chosen("car", 4.0, "left", {}),
               past(lambda d: tree_shadows(d, (0.2, 0.42, 0.58, 0.83), SHADE_DEPTH),
                    lambda d: pillar_at(d, 0.34, 6), lambda d: pillar_at(d, 0.7, 6),
                    lambda d: posts_at(d, (0.52,), 12))),
    FixedScene("case6", "total", "it turns behind trees",
               chosen("car", 4.5, "right", {"surroundings": "town"}), _turn_behind_trees),
    FixedScene("phases", "total", "clear, half hidden by a parked van, hidden by a parked coach",
               chosen("car", 4.0, "right", {}), past(_past_parked_vehicles)),
)  # fmt: skip

CASES: dict[str, FixedScene] = {case.name: case for case in _TABLE}
"""The table by name."""
