"""Whether what is followed still is the target: alike as it used to be, and where its motion leads.

An occluder that takes a target over is seldom unlike it at once. A first doubt freezes all that is
learnt and holds the particles to the foretold motion; only looks that fall far, or a place beside
that motion, make the target hidden.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from vehicle_pf_tracker.trackers.fusion.appearance import Likeness

_RATE = 0.05
_DEVIATIONS = 5.0
_LEAST_FALL = 0.08
_LEAST_FALL_YOUNG = 0.3
_YOUNG = 15
"""Frames after the start in which looks still settle."""
_LEAST_COLOUR = 0.6
_ANCHOR_SETTLED = 20
_LEAST_ANCHOR = 0.6
"""Share of its level that the anchor has to keep: what slips over the target slowly changes the
following template along."""
_HIGH_ANCHOR = 0.8
_DOUBTED_AFTER = 2
_DOUBTED_BELOW = 0.85
_DOUBTED_ANCHOR = 0.6
_TRUSTED_ABOVE = 0.9
_ALIKE_BY_COLOUR = 0.93
_GONE = 0.75
"""Share of the clear level below which neither the whole nor a half is in sight."""
_OFF = 0.45
"""Distance from the foretold place, of the size, that an occluder has dragged the estimate by."""
_OFF_INNOVATIONS = 4.0
_TURNING_OFF = 0.3
_STILL_ALIKE = 0.2
"""Share of the clear level that a vehicle keeps from one frame of its turn to the next."""
_HIDDEN_AFTER = 3
_FORGIVEN_OFF = 0.35
_INNOVATION_RATE = 0.1


@dataclass(frozen=True, slots=True)
class Verdict:
    """What a frame's estimate is worth.

    Attributes
    ----------
    clear : bool
        Whether looks leave no doubt, so that it counts as a sighting and references learn.
    turning : bool
        Whether looks have changed but the colours and the path have not.
    gone : bool
        Whether it is not what is seen here.
    hidden : bool
        Whether that has lasted, so that the target is to be taken for hidden from now on.
    renewed : bool
        Whether changed looks are the target's from now on.
    """

    clear: bool
    turning: bool = False
    gone: bool = False
    hidden: bool = False
    renewed: bool = False


@dataclass(frozen=True, slots=True)
class Sight:
    """What is seen at an estimate.

    Attributes
    ----------
    likeness : Likeness
        Of the image there.
    off : float
        Distance from its foretold place, of the size.
    best_half : callable
        Gives the correlation of the half that is most alike; asked in doubt alone.
    background : bool
        Whether what is seen there was there before the target.
    grey : bool
        Whether the video has no colours.
    """

    likeness: Likeness
    off: float
    best_half: Callable[[], float]
    background: bool = False
    grey: bool = False


class Suspicion:
    """Judges the estimates of one track against its levels in clear frames.

    Attributes
    ----------
    frames : int
        Number of frames in doubt on end.
    innovation : float
        Usual distance of clear estimates from their foretold place, of the size.
    doubtful : bool
        Whether the doubt is such that the target had better not be claimed.
    """

    def __init__(self) -> None:
        self.frames = 0
        self.innovation = 0.1
        self.doubtful = False
        self._level: float | None = None
        self._anchor = 1.0
        self._deviation = 0.05
        self._colour = 0.5
        self._age = 0
        self._gone = 0

    def settle(self, likeness: Likeness) -> None:
        """Take the first looks for the clear level, at the start and after `renew`."""
        if self._level is not None:
            return
        self._level, self._colour = likeness.following, likeness.colour
        self._anchor = likeness.anchor

    @property
    def level(self) -> float:
        """Usual correlation with the following template in clear frames."""
        return self._level or 1.0

    def share(self, likeness: Likeness) -> float:
        """Correlation as a share of its clear level, 0 to 1."""
        return min(likeness.following / max(self.level, 1e-3), 1.0)

    def is_strong(self, likeness: Likeness) -> bool:
        """Whether a candidate looks as the target does in clear frames."""
        least = self.level - max(3 * self._deviation, 0.05)
        return likeness.following >= least and likeness.colour >= 0.7 * self._colour

    def is_fair(self, likeness: Likeness) -> bool:
        """Whether a candidate may be the target."""
        alike = likeness.following > _GONE * self.level
        return alike and likeness.colour > _LEAST_COLOUR * self._colour

    def judge(self, sight: Sight, *, gate: bool, patience: int) -> Verdict:
        """Judge one estimate.

        Parameters
        ----------
        sight : Sight
            What is seen there.
        gate : bool
            Whether a place beside the foretold one tells of an occluder.
        patience : int
            Frames of doubt on the foretold path after which the new looks are the target's.
        """
        verdict = self._verdict(sight, gate=gate, patience=patience)
        self.doubtful = self._had_better_not_be_claimed(sight.likeness)
        return verdict

    def _had_better_not_be_claimed(self, likeness: Likeness) -> bool:
        if self.doubtful:
            alike = likeness.following >= _TRUSTED_ABOVE * self.level
            return not alike or likeness.anchor < _TRUSTED_ABOVE * self._anchor
        unlike = likeness.following < _DOUBTED_BELOW * self.level
        unlike |= likeness.anchor < _DOUBTED_ANCHOR * self._anchor
        return unlike and self.frames >= _DOUBTED_AFTER

    def _verdict(self, sight: Sight, *, gate: bool, patience: int) -> Verdict:
        likeness, off = sight.likeness, sight.off
        self._age += 1
        if not sight.background and self.is_clear(likeness):
            self.frames = 0
            self.innovation += _INNOVATION_RATE * (min(off, _TURNING_OFF) - self.innovation)
            self._gone = max(self._gone - 1, 0)
            self._follow(likeness)
            return Verdict(clear=True)
        self.frames += 1
        turning = (
            not sight.grey
            and likeness.following >= _STILL_ALIKE * self.level
            and likeness.colour >= _ALIKE_BY_COLOUR * self._colour
            and off < _TURNING_OFF
        )
        dragged = gate and off > max(_OFF, _OFF_INNOVATIONS * self.innovation)
        unlike = likeness.following < _GONE * self.level and sight.best_half() < _GONE
        gone = not turning and (dragged or unlike)
        self._gone = self._gone + 1 if gone else max(self._gone - 1, 0)
        if self.frames > patience and not self._gone and off < _FORGIVEN_OFF:
            self.frames = 0
            self._level, self._deviation = likeness.following, 0.05
            self._colour = likeness.colour
            return Verdict(clear=True, turning=turning, renewed=True)
        return Verdict(False, turning, gone, self._gone >= _HIDDEN_AFTER)

    def reset(self) -> None:
        """Forget the doubts; the levels stay."""
        self.frames = self._gone = 0
        self.doubtful = False

    def renew(self) -> None:
        """Forget the levels too, since the looks have changed."""
        self.reset()
        self._level, self._deviation = None, 0.05

    def is_clear(self, likeness: Likeness) -> bool:
        """Whether looks are as they use to be."""
        fall = _LEAST_FALL if self._age > _YOUNG else _LEAST_FALL_YOUNG
        least = self.level - max(_DEVIATIONS * self._deviation, fall)
        anchor = _LEAST_ANCHOR * min(self._anchor, _HIGH_ANCHOR)
        return (
            likeness.following >= least
            and likeness.colour >= _LEAST_COLOUR * self._colour
            and (likeness.anchor >= anchor or self._age < _ANCHOR_SETTLED)
        )

    def _follow(self, likeness: Likeness) -> None:
        away = min(abs(likeness.following - self.level), 2 * self._deviation)
        self._deviation += _RATE * (away - self._deviation)
        self._level = self.level + _RATE * (likeness.following - self.level)
        self._colour += _RATE * (likeness.colour - self._colour)
        self._anchor += _RATE * (likeness.anchor - self._anchor)
