# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""An occluder in front of the vehicle: its position in each frame, and the share it hides."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from laboratory.stress.changes import Painter, Size
from laboratory.stress.coverage import Floats, visible_share
from laboratory.stress.footage import StressFootage
from laboratory.stress.painting import Texture, blend
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.truth import Occlusion, Truth

Similarity = tuple[float, float, float, float]
"""a, b, x, y of the map ``(a x - b y + x, b x + a y + y)``."""
_STANDING: Similarity = (1.0, 0.0, 0.0, 0.0)
"""Map of a camera that stands."""


@dataclass(frozen=True, slots=True)
class Motion:
    """Motion of a rectangle, given in the frame `anchor`, through other frames.

    Attributes
    ----------
    anchor : int
        Index of the frame in whose coordinates the rectangle is given.
    velocity : (float, float)
        Motion of its own, px per frame of the sequence.
    first : int
        Index of the frame that `carried` begins with.
    carried : tuple of Similarity
        Motion of the background from frame `anchor` to each frame; empty where it does not move,
        or the occluder moves with the image instead.
    """

    anchor: int
    velocity: tuple[float, float] = (0.0, 0.0)
    first: int = 0
    carried: tuple[Similarity, ...] = ()

    def from_anchor(self, points: Floats, index: int) -> Floats:
        """Take points (N, 2) of frame `anchor` to frame `index`."""
        # Its own motion first: the velocity is in px of the anchor frame, as it was measured there.
        moved = points + (index - self.anchor) * np.asarray(self.velocity)
        a, b, x, y = self.carried[index - self.first] if self.carried else _STANDING
        # Points are rows: the matrix is transposed.
        turn = np.array([[a, b], [-b, a]])
        return np.asarray(moved @ turn + np.array([x, y]))

    def to_anchor(self, points: Floats, first: int) -> Floats:
        """Take points (frames, N, 2) of the frames from `first` on to frame `anchor`."""
        count = len(points)
        begin = first - self.first
        carried = self.carried[begin : begin + count] if self.carried else (_STANDING,) * count
        a, b, x, y = np.array(carried).T
        moved = points - np.stack([x, y], axis=1)[:, np.newaxis]
        # The inverse of each similarity, all frames at once; none is singular, as a scale is not 0.
        back = np.array([[a, -b], [b, a]]) / (a * a + b * b)
        turned = np.einsum("fnk,kjf->fnj", moved, back)
        own = np.arange(first, first + count)[:, np.newaxis] - self.anchor
        return np.asarray(turned - (own * np.asarray(self.velocity))[:, np.newaxis])


@dataclass(frozen=True, slots=True)
class Occluder:
    """An opaque rectangle that moves rigidly, with a texture.

    Attributes
    ----------
    rectangle : Box
        Rectangle in the coordinates of the motion's anchor frame, px.
    motion : Motion
        Motion through the sequence.
    texture : Texture
        Surface of the occluder.
    """

    rectangle: Box
    motion: Motion
    texture: Texture

    def size(self, size: Size) -> Size:
        """Return `size`."""
        return size

    def corners(self, index: int) -> Floats:
        """Return the corners in frame `index`, clockwise, (4, 2) px."""
        return self.motion.from_anchor(np.asarray(self.rectangle.corners), index)

    def visible_share(self, box: Box, index: int, size: Size) -> float:
        """Compute the share of a box that is not behind the occluder, of its part in the image."""
        return visible_share(self.corners(index), box, size)

    def truth(self, truth: Truth, index: int, size: Size, _seed: int) -> Truth:
        """Combine what the sequence says about the vehicle with what the occluder hides."""
        # Coverage of the box, as the shape of a filmed vehicle is not known.
        share = self.visible_share(truth.box, index, size)
        painted = Occlusion.of(share)
        if painted is Occlusion.NONE:
            return truth
        # How much of a vehicle that was hidden in part is left is not known.
        known = share if truth.occlusion is Occlusion.NONE else None
        # What either hides is hidden; what both hide in part may be the same part.
        hidden = max(truth.occlusion, painted)
        return replace(truth, occlusion=Occlusion(hidden), visible_fraction=known)

    def painter(self, footage: StressFootage, _seed: int) -> Painter:
        """Prepare the texture, and paint it into frames."""
        texture = self.texture.make(footage, self.rectangle)
        return lambda frame, index: blend(frame, texture, self.corners(index))


def similarities(matrices: Iterable[Floats]) -> tuple[Similarity, ...]:
    """Write (3, 3) similarities as plain numbers, to a thousandth of a pixel."""
    # Six digits of turn and scale: a thousandth of a pixel, too, 1000 px from the origin.
    return tuple(
        (
            round(float(m[0, 0]), 6),
            round(float(m[1, 0]), 6),
            round(float(m[0, 2]), 3),
            round(float(m[1, 2]), 3),
        )
        for m in matrices
    )
