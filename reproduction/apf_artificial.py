"""The first paper's artificial video: a vehicle at constant speed, with or without a dark bar.

The paper calls a bar of 30 px a total occlusion, so the vehicle is no longer than that. How large
and how fast it is, the paper does not say.
"""

from __future__ import annotations

from reproduction.cells import SceneChoice
from vehicle_pf_tracker.core.truth import Occlusion, Truth

VEHICLE_WIDTH, VEHICLE_HEIGHT = 30.0, 22.0
SPEED = 5.0
"""px/frame, where the paper keeps it constant."""
SETTING = (
    f"The artificial video (scene `bar`): a {VEHICLE_WIDTH:g} x {VEHICLE_HEIGHT:g} px vehicle on "
    "even ground with sensor noise, 15 frames per second."
)


def artificial_video(width: float, speed: float = SPEED) -> SceneChoice:
    """Choose the video with a bar of `width` px; 0 leaves it out."""
    size = {"vehicle_width": VEHICLE_WIDTH, "vehicle_height": VEHICLE_HEIGHT}
    return SceneChoice.of("bar", {"speed": float(speed), "width": float(width), **size})


def covered(truths: list[Truth]) -> tuple[int, int] | None:
    """Return the first and the last frame (from 1) in which something hides the vehicle."""
    frames = [n for n, t in enumerate(truths, start=1) if t.occlusion is not Occlusion.NONE]
    return (frames[0], frames[-1]) if frames else None
