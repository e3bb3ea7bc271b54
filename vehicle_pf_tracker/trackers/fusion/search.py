"""The search for a hidden target around the place that its motion foretells."""

from __future__ import annotations

import math
from dataclasses import dataclass

from vehicle_pf_tracker.core.box import Box, Position
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.image.camera_motion import CameraMotion
from vehicle_pf_tracker.image.small_grey import SmallGrey
from vehicle_pf_tracker.trackers.fusion.appearance import Appearance
from vehicle_pf_tracker.trackers.fusion.background import Background
from vehicle_pf_tracker.trackers.fusion.candidates import Candidate, Candidates, Chain
from vehicle_pf_tracker.trackers.fusion.suspicion import Suspicion
from vehicle_pf_tracker.trackers.fusion.view import View

_SIZES_AT_FIRST = tuple(1.04**step for step in (-2, -1, 0, 1, 2))
_SIZES = tuple(1.12**step for step in (-3, -2, -1, 0, 1, 2, 3))
_SIZES_CLOSE = tuple(1.04**step for step in (-1, 0, 1))
_COARSE_BEYOND = 0.8
"""Distance, of the size, from which on it is looked for coarsely first, and then closely."""
_CLOSE = 0.25
"""What is looked at around a place that was found coarsely, of the size."""
_AT_FIRST = 4.0
"""Frames hidden in which the size cannot have changed much."""
_MARGIN = 0.3
"""What is looked at beyond the search itself to every side, of the larger side of the box."""
_FARTHEST = 4.0
"""Limit of the search, of the size."""


@dataclass(frozen=True, slots=True)
class Foretold:
    """State that a hidden target should have.

    Attributes
    ----------
    place, velocity : (float, float)
        In px and px per frame.
    scale : float
        Relative to the first box.
    extent : float
        Geometric mean of the sides of its box, px.
    width : float
        Standard deviation of the particles that drift around it, px.
    """

    place: Position
    velocity: Position
    scale: float
    extent: float
    width: float


class Search:
    """Looks for one hidden target until a chain of candidates is proof enough.

    Parameters
    ----------
    appearance : Appearance
        What it looks like.
    suspicion : Suspicion
        What its looks used to be worth.
    background : Background
        What was to be seen without it.
    """

    def __init__(
        self, appearance: Appearance, suspicion: Suspicion, background: Background
    ) -> None:
        self._appearance = appearance
        self._suspicion = suspicion
        self._background = background
        self._candidates = Candidates()
        self._frames = 0.0

    def age(self, elapsed: float, motion: CameraMotion) -> None:
        """Let `elapsed` frames pass in which the camera made `motion`."""
        self._candidates.age(elapsed, motion)
        self._frames += elapsed

    def look(
        self, frame: Frame, small: SmallGrey, foretold: Foretold, *, wide: bool, sizes: bool
    ) -> float:
        """Look for a candidate by a dense search.

        Parameters
        ----------
        frame : (H, W, 3) array
            RGB.
        small : SmallGrey
            The same, reduced.
        foretold : Foretold
            Where to look.
        wide : bool
            Whether to look further than its very place.
        sizes : bool
            Whether to look for other sizes.

        Returns
        -------
        float
            Looks of the best place as a share of their clear level, 0 to 1.
        """
        reach = self._reach(foretold)
        around = _MARGIN * max(self._appearance.size) * foretold.scale + (reach if wide else 0.0)
        view = self._view(frame, foretold, min(around, float(max(frame_size(frame)))), sizes=sizes)
        peak = view.best(foretold.place, reach, frame_size(frame))
        if around > _COARSE_BEYOND * foretold.extent:
            view = self._appearance.look(
                frame, peak.place, peak.scale, _CLOSE * foretold.extent,
                _SIZES_CLOSE if sizes else (1.0,),
            )  # fmt: skip
            peak = view.best(peak.place, reach, frame_size(frame))
        likeness = self._appearance.compare(view, peak.place, peak.scale)
        strong = self._suspicion.is_strong(likeness)
        near = math.dist(peak.place, foretold.place) < self._near(foretold)
        alike = strong or (near and self._suspicion.is_fair(likeness))
        width, height = self._appearance.size
        box = Box.around(peak.place, width * peak.scale, height * peak.scale)
        if alike and not self._background.shows(small, box):
            self._candidates.add(Candidate(peak.place, peak.scale, strong))
        return self._suspicion.share(likeness)

    def _view(self, frame: Frame, foretold: Foretold, around: float, *, sizes: bool) -> View:
        """Look all around; at half the resolution where that is far."""
        steps = _SIZES if self._frames > _AT_FIRST else _SIZES_AT_FIRST
        steps = steps if sizes else (1.0,)
        coarser = 2.0 if around > _COARSE_BEYOND * foretold.extent else 1.0
        return self._appearance.look(
            frame, foretold.place, coarser * foretold.scale, around,
            tuple(step / coarser for step in steps),
        )  # fmt: skip

    def _reach(self, foretold: Foretold) -> float:
        """How far the target may be from its foretold place, px; it widens with the particles."""
        widened = foretold.extent * (0.5 + 0.05 * self._frames) + 1.5 * foretold.width
        return min(widened, _FARTHEST * foretold.extent)

    def _near(self, foretold: Foretold) -> float:
        """Distance from the foretold place within which looks need only be fair, px."""
        share = max(0.3 + 0.03 * self._frames, 3 * self._suspicion.innovation)
        return share * foretold.extent + 2

    def proof(self, foretold: Foretold, confirm: int) -> Chain | None:
        """Give the chain of candidates that has to be the target, if there is one."""
        chain = self._candidates.chain(foretold.extent)
        noise = max(0.03, 2 * self._suspicion.innovation) * foretold.extent
        tolerance = max(1.0, 0.35 * math.hypot(*foretold.velocity), noise)
        if chain is None:
            return None
        away = math.dist(chain.links[-1].place, foretold.place) / self._near(foretold)
        return chain if chain.proves(foretold.velocity, tolerance, confirm, away) else None
