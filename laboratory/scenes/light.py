# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Drives in changing light: shadows of trees across the road, and a cloud that passes."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.parameters.table import parameter
from vehicle_pf_tracker.scenes.cameras import DISTURBANCES, OutdoorCamera
from vehicle_pf_tracker.scenes.compositing import Colour, Sprite
from vehicle_pf_tracker.scenes.courses import standing
from vehicle_pf_tracker.scenes.drive import Drive, DriveParameters
from vehicle_pf_tracker.scenes.grounds import value_noise
from vehicle_pf_tracker.scenes.random_streams import stream
from vehicle_pf_tracker.scenes.scene import Actor, Scene
from vehicle_pf_tracker.scenes.solids import SHADOW_TINT


@dataclass(frozen=True, slots=True)
class ShadowParameters(DriveParameters):
    """Parameters of static shadows."""

    depth: float = parameter(
        0.55, "deeper shadows change the target's colours more", bounds=(0.1, 0.8)
    )


@dataclass(frozen=True, slots=True)
class IlluminationParameters(DriveParameters):
    """Parameters of changing light."""

    dimming: float = parameter(
        0.45, "the share of the light that the cloud takes away", bounds=(0.05, 0.8)
    )


@dataclass(frozen=True, slots=True)
class Cloud:
    """A cloud before the sun: darker and bluer light from frame `start` for `length` frames.

    The light falls and rises over a fifth of the time each; after it the sun is warmer.
    """

    start: float
    length: float
    dimming: float

    def __call__(self, frame: float) -> Colour:
        """Give the gains of red, green and blue in `frame`."""
        into = (frame - self.start) / self.length
        cover = float(np.interp(into, (0, 0.2, 0.8, 1.0), (0, 1, 1, 0)))
        # Behind the cloud the light is bluer, as the sky is left; then warmer, by 6 %. Choices.
        warmth = 0.06 * float(np.interp(into, (0.8, 1.0), (0, 1)))
        light = 1 - self.dimming * cover
        return light * (1 - 0.08 * cover + warmth), light, light * (1 + 0.1 * cover - warmth)


@dataclass(frozen=True, slots=True)
class CloudyCamera(OutdoorCamera):
    """A camera on a mast while a cloud passes."""

    cloud: Cloud

    def gain(self, index: int) -> Colour:
        """Give the gains of red, green and blue in frame `index`."""
        flicker = OutdoorCamera.gain(self, index)[0]
        red, green, blue = self.cloud(index)
        return red * flicker, green * flicker, blue * flicker


def tree_shadows(drive: Drive, shares: tuple[float, ...], depth: float) -> list[Actor]:
    """Let trees outside the image cast dappled shadows across the road, and on what drives there.

    Parameters
    ----------
    drive : Drive
        The drive.
    shares : tuple of float
        Places along the way.
    depth : float
        Share of the light that is missing in the darkest parts.
    """
    rng = stream(drive.seed, "tree shadows")
    top = drive.road.rows.start - 30
    bottom = drive.road.rows.stop + 12
    actors = []
    for share in shares:
        columns = round(rng.uniform(1.6, 2.4) * drive.target.size[0])
        rows = bottom - top
        # 0 in the middle of the shadow, 1 at its sides, ragged as crowns are.
        rim = np.abs(np.linspace(-1, 1, columns)) + 0.25 * value_noise(
            (rows, columns), (16, 12), rng
        )
        sunflecks = value_noise((rows, columns), (6, 7), rng)
        # Full depth inside, none within a tenth of the rim; sunflecks are holes in it.
        opacity = depth * np.clip(3 * (0.9 - rim), 0, 1) * np.clip(1.5 - 2.2 * sunflecks, 0, 1)
        place = Box(drive.x(drive.along(share)) - columns / 2, top, columns, rows)
        sprite = Sprite(np.tile(SHADOW_TINT, (rows, columns, 1)), opacity)
        actors.append(Actor(sprite, standing(place), hides=False))
    return actors


def shadows(parameters: ShadowParameters, seed: int) -> Scene:
    """Make the scene: strong dappled shadows across the road."""
    drive = Drive(parameters, seed)
    places = (0.19, 0.36, 0.52, 0.68, 0.86)
    return drive.scene(tree_shadows(drive, places, parameters.depth))


def illumination(parameters: IlluminationParameters, seed: int) -> Scene:
    """Make the scene: a cloud darkens it for half the time, and then the sun is warmer."""
    drive = Drive(parameters, seed)
    frames = drive.frame_count
    cloud = Cloud(0.2 * frames, 0.5 * frames, parameters.dimming)
    disturbance = DISTURBANCES[parameters.disturbance]
    return replace(drive.scene(), camera=CloudyCamera(disturbance, seed, cloud))
