# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The kinds of cases, and the cases of each that a sequence gives."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any

from laboratory.stress import changes
from laboratory.stress.cases import Case, Start
from laboratory.stress.changes import Change
from laboratory.stress.footage import StressSource, open_footage
from laboratory.stress.occlusion_cases import lorries, poles, walls
from vehicle_pf_tracker.core.truth import Occlusion, Truth

LATER_STARTS = 20
"""Starts within a sequence: as many as OTB's temporal robustness evaluation has."""
_LAST_START = 0.8
"""Share of a recording in which runs start: a fifth of it at least is left to track."""
_LEAST_FRAMES = 20
"""Fewest frames of a case, a choice: with fewer, single frames decide its share on target."""
_LEAST_SIDE = 8.0
"""Side in px below which a reduced vehicle is a dot that no tracker here can learn."""
_SHAKES = (0.01, 0.03)
"""Amplitude in image widths: a mast in wind, a camera held by hand."""
_DROPPED = 0.2
"""Share of dropped frames: a radio link at the edge of its range."""
_SHIFT = 0.1
"""Shift of OTB's spatial robustness (Wu, Lim and Yang 2013), in widths and heights of the box."""
_SCALES = (0.8, 0.9, 1.1, 1.2)
"""Scales of OTB's spatial robustness."""
_SIDES = {
    "left": (-1, 0), "right": (1, 0), "up": (0, -1), "down": (0, 1),
    "left_up": (-1, -1), "right_up": (1, -1), "left_down": (-1, 1), "right_down": (1, 1),
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Kind:
    """A kind of cases.

    Attributes
    ----------
    name : str
        Name of the kind in tables and options.
    group : str
        The group that small batteries draw from in turns.
    summary : str
        One line about it.
    cases : callable
        Makes the cases of a sequence for a seed.
    """

    name: str
    group: str
    summary: str
    cases: Callable[[StressSource, int], Iterator[Case]]


def case_seed(seed: int, *words: object) -> int:
    """Derive the seed of a case from the battery's and the case's name."""
    # `hash` differs from process to process, and so would the cases.
    return zlib.crc32("/".join(map(str, (seed, *words))).encode())


def _playing(origin: StressSource, kind: str, variation: str = "", **more: Any) -> Iterator[Case]:
    """Yield the case of all frames from the first one with truth on."""
    footage = open_footage(origin.source)
    # Without truth there is no box to start on.
    first = next((i for i, truth in enumerate(footage.truth) if truth is not None), 0)
    count = len(footage.truth) - first
    if count >= _LEAST_FRAMES:
        yield Case(origin, kind, variation, first, count, **more)


def _plain(origin: StressSource, seed: int) -> Iterator[Case]:
    yield from _playing(origin, "plain", seed=seed)


def _mirrored(origin: StressSource, seed: int) -> Iterator[Case]:
    yield from _playing(origin, "mirrored", seed=seed, changes=(changes.Mirror(),))


def _reversed(origin: StressSource, seed: int) -> Iterator[Case]:
    truths = open_footage(origin.source).truth
    last = _last_in_view(truths)
    if last + 1 >= _LEAST_FRAMES:
        yield Case(origin, "reversed", "", last, last + 1, -1, seed)


def _last_in_view(truths: tuple[Truth | None, ...]) -> int:
    """Index of the last frame in full view, else of the last that is not hidden; else -1."""
    # A run that is played backwards starts here, and should see the whole vehicle if it can.
    for accepted in ({Occlusion.NONE}, {Occlusion.NONE, Occlusion.PARTIAL}):
        for index in range(len(truths) - 1, -1, -1):
            truth = truths[index]
            if truth is not None and truth.occlusion in accepted:
                return index
    return -1


def _half_rate(origin: StressSource, seed: int) -> Iterator[Case]:
    for case in _playing(origin, "half_rate", seed=seed):
        # As many seconds as before, so that the vehicle drives twice as far between two frames.
        yield replace(case, step=2, count=(case.count + 1) // 2)


def _dropped(origin: StressSource, seed: int) -> Iterator[Case]:
    yield from _playing(origin, "dropped_frames", seed=seed, dropped=_DROPPED)


def later_starts(truths: Sequence[Truth | None], count: int) -> list[int]:
    """Return the indices of `count` frames with truth, spread evenly over most of a sequence.

    The first one is left out. Where the vehicle is hidden, even in part, the next frame in which it
    is not is taken; so there may be fewer.
    """
    known = [(index, truth) for index, truth in enumerate(truths) if truth is not None]
    starts = []
    for number in range(1, count + 1):
        # Evenly by index of frames with truth: gaps in it are no places to start.
        begin = round(number * _LAST_START * (len(known) - 1) / count)
        clear = (n for n in range(begin, len(known)) if known[n][1].occlusion is Occlusion.NONE)
        # 0, the first frame, stands for "none": it is dropped below.
        starts.append(next(clear, 0))
    return [known[n][0] for n in dict.fromkeys(starts) if n]


def _later_start(origin: StressSource, seed: int) -> Iterator[Case]:
    truths = open_footage(origin.source).truth
    for first in later_starts(truths, LATER_STARTS):
        if len(truths) - first >= _LEAST_FRAMES:
            count = len(truths) - first
            yield Case(origin, "later_start", f"{first + 1:06d}", first, count, 1, seed)


def shifted_starts() -> list[Start]:
    """Return the twelve starts of OTB: eight shifts by a tenth of the box, and four scales."""
    shifts = [Start(name, (_SHIFT * x, _SHIFT * y)) for name, (x, y) in _SIDES.items()]
    return shifts + [Start(f"scale_{scale:g}", scale=scale) for scale in _SCALES]


def _shifted_box(origin: StressSource, seed: int) -> Iterator[Case]:
    for start in shifted_starts():
        yield from _playing(origin, "shifted_box", start.name, seed=seed, start=start)


def _changed(kind: str, variations: Mapping[str, Change]) -> Callable[..., Iterator[Case]]:
    def cases(origin: StressSource, seed: int) -> Iterator[Case]:
        for variation, change in variations.items():
            # A seed by name: another kind or another variation leaves this case as it is.
            own = case_seed(seed, origin.name, kind, variation)
            yield from _playing(origin, kind, variation, seed=own, changes=(change,))

    return cases


def _shake(origin: StressSource, seed: int) -> Iterator[Case]:
    for share in _SHAKES:
        # Rounded, as the number is part of the case's identity in the store.
        amplitude = round(share * origin.source.width, 2)
        variation = f"{share:g}"
        own = case_seed(seed, origin.name, "shake", variation)
        change = changes.Shake(amplitude)
        yield from _playing(origin, "shake", variation, seed=own, changes=(change,))


def _reduced(origin: StressSource, seed: int) -> Iterator[Case]:
    for factor in (0.75, 0.5):
        change = (changes.Reduction(factor),)
        for case in _playing(origin, "reduced", f"{factor:g}", seed=seed, changes=change):
            # The start decides: a vehicle that grows later can be learnt, one that shrinks was.
            box = case.start_box()
            if min(box.width, box.height) >= _LEAST_SIDE:
                yield case


def _kinds() -> Iterator[Kind]:
    yield Kind("plain", "view", "the sequence as it is", _plain)
    yield Kind("mirrored", "view", "left and right swapped", _mirrored)
    yield Kind("reversed", "view", "played backwards from the last frame in view", _reversed)
    yield Kind("half_rate", "view", "every second frame, at half the frame rate", _half_rate)
    yield Kind("dropped_frames", "view", "a fifth of the frames missing, at random", _dropped)
    yield Kind(
        "later_start", "start", "20 first frames over the sequence, vehicle in full view (TRE)",
        _later_start,
    )  # fmt: skip
    yield Kind(
        "shifted_box", "start", "8 first boxes shifted by a tenth, 4 scaled 0.8 to 1.2 (SRE)",
        _shifted_box,
    )  # fmt: skip
    yield Kind(
        "brightness", "image", "all levels times 0.6 or 1.4",
        _changed("brightness", {f"{g:g}": changes.Brightness(g) for g in (0.6, 1.4)}),
    )  # fmt: skip
    yield Kind(
        "gamma", "image", "all levels to the power 0.6 or 1.7",
        _changed("gamma", {f"{g:g}": changes.Gamma(g) for g in (0.6, 1.7)}),
    )  # fmt: skip
    yield Kind(
        "noise", "image", "Gaussian noise of 8 or 20 grey levels",
        _changed("noise", {f"{d:g}": changes.Noise(d) for d in (8.0, 20.0)}),
    )  # fmt: skip
    yield Kind(
        "jpeg", "image", "JPEG of quality 30 or 10",
        _changed("jpeg", {f"{q}": changes.Jpeg(q) for q in (30, 10)}),
    )  # fmt: skip
    yield Kind(
        "blur", "image", "Gaussian blur of 1 or 2 px",
        _changed("blur", {f"{d:g}": changes.Blur(d) for d in (1.0, 2.0)}),
    )  # fmt: skip
    yield Kind("shake", "camera", "the camera sways by 1 % or 3 % of the width", _shake)
    yield Kind("reduced", "camera", "images reduced to 3/4 or 1/2 of their sides", _reduced)
    yield Kind(
        "wall", "occluder", "a standing wall hides the vehicle for 5, 10, 20 or 40 frames", walls
    )
    yield Kind("pole", "occluder", "a standing post hides part of the vehicle", poles)
    yield Kind(
        "lorry", "occluder", "a lorry drives across, fast or slow, 5 to 40 frames hidden", lorries
    )


STRESS_KINDS: Mapping[str, Kind] = MappingProxyType({kind.name: kind for kind in _kinds()})
