# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The artificial video of the APF paper: a vehicle passes behind a dark vertical bar."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.parameters.table import parameter
from vehicle_pf_tracker.scenes.cameras import Camera
from vehicle_pf_tracker.scenes.compositing import Sprite
from vehicle_pf_tracker.scenes.courses import moving, standing
from vehicle_pf_tracker.scenes.grounds import plain
from vehicle_pf_tracker.scenes.random_streams import stream
from vehicle_pf_tracker.scenes.scene import Actor, Scene, noise_parameter, stamps_parameter
from vehicle_pf_tracker.scenes.solids import draw
from vehicle_pf_tracker.scenes.vehicles import car

WIDTH = 640
"""Width of the artificial video, px (Scharcanski 2011)."""
HEIGHT = 480
"""Height of the artificial video, px."""
BAR_MARGIN = 20
"""Free pixels between the vehicle and the image's sides in the first and the last frame."""
_SOURCE = "Scharcanski 2011, section IV"


@dataclass(frozen=True, slots=True)
class BarParameters:
    """Parameters of the artificial video."""

    speed: float = parameter(
        5.0, "faster vehicles need a wider search, and the video gets shorter",
        bounds=(0.5, 40.0), unit="px/frame", source=_SOURCE,
    )  # fmt: skip
    width: float = parameter(
        30.0, "wider bars hide the vehicle for longer; 0 leaves the bar out",
        bounds=(0.0, 120.0), unit="px", source=_SOURCE,
    )  # fmt: skip
    vehicle_width: float = parameter(
        40.0, "longer vehicles stay partly visible for longer",
        bounds=(8.0, 100.0), unit="px",
    )  # fmt: skip
    vehicle_height: float = parameter(
        30.0, "taller vehicles fill more of the image", bounds=(8.0, 100.0), unit="px"
    )
    noise: float = noise_parameter(2.0)
    frame_rate: float = stamps_parameter(15.0, "speed is", _SOURCE)


def bar(parameters: BarParameters, seed: int) -> Scene:
    """Make the scene: constant speed to the right at mid-height, the bar in the middle."""
    size = parameters.vehicle_width, parameters.vehicle_height
    vehicle = Actor(
        draw(car((196, 44, 36)), *size),
        moving(Box(BAR_MARGIN, (HEIGHT - size[1]) / 2, *size), parameters.speed),
    )
    # Its left edge is on a whole pixel.
    box = Box(WIDTH // 2 - parameters.width // 2, 0.0, parameters.width, HEIGHT)
    obstacle = Actor(Sprite.plain((34.0, 34.0, 38.0)), standing(box))
    run = WIDTH - 2 * BAR_MARGIN - parameters.vehicle_width
    return Scene(
        width=WIDTH,
        height=HEIGHT,
        frame_rate=parameters.frame_rate,
        frame_count=int(run / parameters.speed) + 1,
        backdrop=lambda: plain((HEIGHT, WIDTH), (168, 170, 166), stream(seed, "backdrop")),
        actors=(vehicle, obstacle) if parameters.width else (vehicle,),
        target=0,
        camera=Camera(parameters.noise, seed),
    )
