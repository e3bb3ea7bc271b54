"""Where a run starts: on the first true box, or, to see how robust it is, elsewhere.

Shifted starts and other first frames are those of the OTB benchmark (Wu, Lim and Yang 2013, "Online
object tracking: a benchmark", spatial and temporal robustness evaluation); failures and re-starts
are those of VOT, see `evaluation.failures`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.truth import Occlusion, Truth

SHIFTED, FRAMES, RESTARTS = "shifted_starts", "start_frames", "restarts"
_SHIFT = 0.1
"""Of the box's width and height."""
_SCALES = (0.8, 0.9, 1.1, 1.2)
_SIDES = {"left": (-1, 0), "right": (1, 0), "up": (0, -1), "down": (0, 1)}
_CORNERS = {
    "left_up": (-1, -1),
    "right_up": (1, -1),
    "left_down": (-1, 1),
    "right_down": (1, 1),
}
_LAST_START = 0.8
"""Share of a recording in which runs start; later ones would tell little."""


@dataclass(frozen=True, slots=True)
class Start:
    """Where a run starts, and whether it is started anew after failures.

    Attributes
    ----------
    kind : str
        What it is for; empty for the grid itself.
    name : str
        Which one of its kind.
    stamp_ns : int or None
        Stamp of the true box it starts on; None for the first one.
    shift : tuple of float
        The box is moved by so many of its widths and heights.
    scale : float
        And its sides are so many times as long.
    """

    kind: str = ""
    name: str = ""
    stamp_ns: int | None = None
    shift: tuple[float, float] = (0.0, 0.0)
    scale: float = 1.0

    def on(self, truths: Sequence[Truth]) -> Truth:
        """Return the truth to start on, its box shifted and scaled.

        Parameters
        ----------
        truths : sequence of Truth
            All of the recording, in order.
        """
        truth = next(t for t in truths if self.stamp_ns in {None, t.stamp_ns})
        box = truth.box
        centre = (
            box.centre[0] + self.shift[0] * box.width,
            box.centre[1] + self.shift[1] * box.height,
        )
        around = Box.around(centre, box.width * self.scale, box.height * self.scale)
        return replace(truth, box=around if self.moves else box)

    @property
    def moves(self) -> bool:
        """Whether the box is another one than the true one."""
        return self.shift != (0.0, 0.0) or self.scale != 1.0


USUAL = Start()
"""The first true box."""


def shifted_starts() -> list[Start]:
    """Return the twelve starts of OTB: eight shifts by a tenth of the box, and four scales."""
    shifts = [
        Start(SHIFTED, name, shift=(_SHIFT * x, _SHIFT * y))
        for name, (x, y) in {**_SIDES, **_CORNERS}.items()
    ]
    return shifts + [Start(SHIFTED, f"scale_{scale:g}", scale=scale) for scale in _SCALES]


def start_frames(truths: Sequence[Truth], count: int) -> list[Start]:
    """Return starts on `count` true boxes, spread evenly over most of a recording.

    The usual start is left out. Where the vehicle is hidden, even in part, the next frame in which
    it is not is taken; so there may be fewer.
    """
    places: list[int] = []
    for number in range(1, count + 1):
        place = round(number * _LAST_START * (len(truths) - 1) / count)
        clear = (i for i in range(place, len(truths)) if truths[i].occlusion is Occlusion.NONE)
        found = next(clear, None)
        if found and found not in places:
            places.append(found)
    return [
        Start(FRAMES, f"start-{number}", truths[place].stamp_ns)
        for number, place in enumerate(places, start=1)
    ]
