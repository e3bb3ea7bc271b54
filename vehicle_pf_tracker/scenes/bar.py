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

"""The artificial video of the APF paper: a vehicle passes behind a dark vertical bar.

Source: Scharcanski et al. 2011, section IV, figures 1 to 4.
"""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.parameters.table import parameter
from vehicle_pf_tracker.scenes.cameras import Camera
from vehicle_pf_tracker.scenes.compositing import Image, Sprite, stream
from vehicle_pf_tracker.scenes.paths import Still, Straight
from vehicle_pf_tracker.scenes.scene import Actor, Scene
from vehicle_pf_tracker.scenes.solids import draw, plain
from vehicle_pf_tracker.scenes.vehicles import car

WIDTH, HEIGHT = 640, 480
MARGIN = 20
"""Free pixels between the vehicle and the image's sides in the first and the last frame."""

_SOURCE = "Scharcanski 2011, section IV"


@dataclass(frozen=True, slots=True)
class BarParameters:
    """Parameters of the artificial video."""

    speed: float = parameter(
        5.0, "faster vehicles need a wider search, and the video gets shorter",
        minimum=0.5, maximum=40.0, unit="px/frame", source=_SOURCE,
    )  # fmt: skip
    width: float = parameter(
        30.0, "wider bars hide the vehicle for longer; 0 leaves the bar out",
        minimum=0.0, maximum=120.0, unit="px", source=_SOURCE,
    )  # fmt: skip
    vehicle_width: float = parameter(
        40.0, "longer vehicles stay partly visible for longer",
        minimum=8.0, maximum=100.0, unit="px",
    )  # fmt: skip
    vehicle_height: float = parameter(
        30.0, "taller vehicles fill more of the image", minimum=8.0, maximum=100.0, unit="px"
    )
    noise: float = parameter(
        2.0, "more makes histograms differ from frame to frame",
        minimum=0.0, maximum=60.0, unit="levels of 255",
    )  # fmt: skip
    frame_rate: float = parameter(
        15.0, "changes the stamps only: speed is per frame",
        minimum=1.0, maximum=240.0, unit="frames/s", source=_SOURCE,
    )  # fmt: skip


def bar(parameters: BarParameters, seed: int) -> Scene:
    """Make the scene: constant speed to the right at mid-height, the bar in the middle."""
    size = parameters.vehicle_width, parameters.vehicle_height
    vehicle = Actor(
        draw(car((196, 44, 36)), *size),
        Straight(Box(MARGIN, (HEIGHT - size[1]) / 2, *size), (parameters.speed, 0.0)),
    )
    run = WIDTH - 2 * MARGIN - parameters.vehicle_width
    return Scene(
        name="bar",
        width=WIDTH,
        height=HEIGHT,
        frame_rate=parameters.frame_rate,
        frame_count=int(run / parameters.speed) + 1,
        backdrop=lambda: _backdrop(seed),
        actors=(vehicle, *_bars(parameters.width)),
        target=0,
        camera=Camera(parameters.noise, seed),
    )


def _backdrop(seed: int) -> Image:
    return plain((HEIGHT, WIDTH), (168, 170, 166), stream(seed, "backdrop"))


def _bars(width: float) -> tuple[Actor, ...]:
    """Make the bar, its left edge on a whole pixel; none for a width of 0."""
    if width == 0:
        return ()
    box = Box(WIDTH // 2 - width // 2, 0.0, width, HEIGHT)
    return (Actor(Sprite.plain((34.0, 34.0, 38.0)), Still(box)),)
