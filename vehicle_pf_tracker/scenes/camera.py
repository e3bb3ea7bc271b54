"""What a camera does to the picture it takes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.scenes.compositing import Image
from vehicle_pf_tracker.scenes.randomness import stream


@dataclass(frozen=True, slots=True)
class Camera:
    """A fixed camera with sensor noise.

    Attributes
    ----------
    noise : float
        Standard deviation of the white Gaussian noise on each channel, in levels of 0 to 255.
    seed : int
        Seed of the scene; each frame has its own stream, so that frames do not depend on order.
    """

    noise: float
    seed: int

    def offset(self, index: int) -> tuple[float, float]:
        """Give the image's top-left corner on the stage, px: it shows the whole stage."""
        return 0.0, 0.0

    def capture(self, picture: Image, index: int) -> Frame:
        """Turn the composed `picture` of frame `index` into an 8-bit frame; alters `picture`."""
        if self.noise > 0:
            grain = stream(self.seed, "sensor noise", index)
            noise = grain.standard_normal(picture.shape, dtype=np.float32)
            noise *= np.float32(self.noise)
            picture += noise
        np.rint(picture, out=picture)
        np.clip(picture, 0, 255, out=picture)
        return picture.astype(np.uint8)
