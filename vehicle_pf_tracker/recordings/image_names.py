# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Order, numbers and times of images by the names of their files."""

from __future__ import annotations

import re
import statistics
from collections.abc import Sequence
from dataclasses import dataclass, field
from datetime import datetime, timezone
from itertools import pairwise
from operator import le
from pathlib import Path

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.recordings.name_times import (
    AmbiguousNamesError,
    Numeral,
    Times,
    epoch_unit,
    times_of,
)

_NUMBER = r"(?<![A-Za-z0-9.])[0-9]+\.[0-9]+(?!\.?[0-9A-Za-z])|[0-9]+"
"""A number in a name. A point is a decimal point unless a letter or a third number touches it, as
in ``shot1.0001`` and ``1.2.3``."""
_PARTS = re.compile(f"({_NUMBER})")
_FRACTION_WIDTHS = {3, 6, 9}
"""Digits of a fraction that stands apart from its seconds, as ``SECONDS_NANOSECONDS`` of bags: ms,
µs or ns with leading zeros. Other widths may have lost their zeros."""
_DATE = re.compile(
    r"(?<![0-9])(20[0-9]{2})[-_.]?([01][0-9])[-_.]?([0-3][0-9])[-_.T ]*"
    r"([0-2][0-9])[-_.:hH]?([0-5][0-9])[-_.:mM]?([0-5][0-9])"
    r"(?:[-_.,]?([0-9]{3}|[0-9]{6}|[0-9]{9}))?(?![0-9])"
)
"""Date and time of day in a name, perhaps with ms, µs or ns."""


@dataclass(frozen=True, slots=True)
class NamedImages:
    """Images in order.

    Attributes
    ----------
    images : dict of int to Path
        The files by their numbers. Where names are times or have no number, these count from 1.
    times_ns : list of int or None
        Times that the names state, ns; None where they count frames.
    since_1970 : bool
        True where the times count from 1970; else from a start that is not known.
    notices : list of str
        Assumptions, a sentence each.
    """

    images: dict[int, Path]
    times_ns: list[int] | None = None
    since_1970: bool = False
    notices: list[str] = field(default_factory=list)


def natural_key(name: str) -> tuple[tuple[str, Numeral], ...]:
    """Return a key that sorts names by their words and by the values of their numbers."""
    # Words and numbers alternate, a word first and last; the last word has no number after it.
    *parts, last = _PARTS.split(name)
    words = parts[::2]
    numbers = map(_numeral, parts[1::2])
    # A last pair without a number keeps the keys of short names comparable with longer ones.
    return (*zip(words, numbers, strict=True), (last, (0, "")))


def number_images(
    paths: Sequence[Path], fps: float | None = None, *, is_given: bool = False
) -> NamedImages:
    """Give the images of one folder the numbers and times of their names.

    Where some names are a number alone, the others are passed over.

    Parameters
    ----------
    paths : sequence of Path
        The images, at least one.
    fps : float or None
        Frame rate that is known, 1/s.
    is_given : bool
        True where the user gave it, so that it takes the place of times in the names.

    Raises
    ------
    InputError
        If two have one number, or the names can be read in several ways.
    """
    # 1. The images whose names are numbers, if there are any, in natural order.
    paths = sorted(paths, key=lambda path: (natural_key(path.stem), path.name))
    # A folder may hold a preview or a map beside its numbered images.
    numbered = [path for path in paths if _PARTS.fullmatch(path.stem)] or paths
    notices = []
    if others := [path for path in paths if path not in set(numbered)]:
        notices.append(f"images without a number alone are passed over: {len(others)}; {others[0]}")
    # 2. The number in each name that orders them.
    column = _dates(numbered) or _column(numbered, is_given=is_given)
    if column is None:
        return _by_order(numbered, notices)
    values, numbered = _sorted_by(column, numbered)
    # 3. Times or a count of frames.
    try:
        times = times_of(values, fps)
    except AmbiguousNamesError as error:
        if fps is not None:
            return _by_order(numbered, notices)
        raise InputError(_refusal(numbered, str(error))) from None
    if times is None:
        return _by_count([integer for integer, _ in values], numbered, notices)
    return _by_order(numbered, notices) if is_given else _by_time(numbered, times, notices)


def _sorted_by(
    column: Sequence[Numeral], paths: Sequence[Path]
) -> tuple[list[Numeral], list[Path]]:
    ordered = sorted(zip(column, paths, strict=True), key=lambda pair: pair[0])
    # Two files of one number are two frames of one time: which is first cannot be known.
    for (value, path), (following, other) in pairwise(ordered):
        if value == following:
            raise InputError(f"{other} and {path.name} have the same number")
    return [value for value, _ in ordered], [path for _, path in ordered]


def _by_order(paths: Sequence[Path], notices: list[str]) -> NamedImages:
    return NamedImages(dict(enumerate(paths, start=1)), notices=notices)


def _by_count(numbers: Sequence[int], paths: Sequence[Path], notices: list[str]) -> NamedImages:
    steps = [after - before for before, after in pairwise(numbers)] or [1]
    # Gaps may be dropped images or every n-th one: the stamps keep them, and a notice says so.
    if (usual := statistics.mode(steps)) != 1:
        notices.append(
            f"the numbers of the images in {paths[0].parent} usually go up by {usual}, and so many "
            "frame periods are from one to the next"
        )
    return NamedImages(dict(zip(numbers, paths, strict=True)), notices=notices)


def _by_time(paths: Sequence[Path], times: Times, notices: list[str]) -> NamedImages:
    if any(after <= before for before, after in pairwise(times.ns)):
        raise InputError(_refusal(paths, "two of them are the same time"))
    origin = "1970" if times.since_1970 else "a start"
    notices.append(
        f"the names of the images in {paths[0].parent} are taken for times in {times.unit} from "
        f"{origin} on; --fps takes their place"
    )
    return NamedImages(dict(enumerate(paths, start=1)), times.ns, times.since_1970, notices)


def _refusal(paths: Sequence[Path], why: str) -> str:
    return (
        f"the names of the images in {paths[0].parent}, {paths[0].name} and so on, leave their "
        f"times open: {why}; give the frame rate with --fps"
    )


def _dates(paths: Sequence[Path]) -> list[Numeral] | None:
    """Return the dates in the names as seconds since 1970, in UTC; None where they do not differ.

    Another time zone moves all of them alike.
    """
    seconds: list[Numeral] = []
    for path in paths:
        if (match := _DATE.search(path.stem)) is None:
            return None
        *fields, fraction = match.groups()
        try:
            moment = datetime(*map(int, fields), tzinfo=timezone.utc)  # type: ignore[misc,arg-type]
        except ValueError:  # as of the 31st of June: numbers of another meaning
            return None
        seconds.append((int(moment.timestamp()), fraction or ""))
    if len(paths) == 1 or len(set(seconds)) < len(paths):
        return None
    # A fraction that goes up by one in its last digit numbers the images of a second.
    digits = sorted(int(fraction) for _, fraction in seconds if fraction)
    steps = [after - before for before, after in pairwise(digits)]
    return None if steps and statistics.mode(steps) == 1 else seconds


def _column(paths: Sequence[Path], *, is_given: bool) -> list[Numeral] | None:
    """Return the number in each name that orders the images; None where their order does."""
    names = [_PARTS.split(path.stem) for path in paths]
    if any(len(parts) == 1 for parts in names):
        return None
    # Names of different words: only their last number can order all of them.
    if any(parts[::2] != names[0][::2] for parts in names):
        last = [_numeral(parts[-2]) for parts in names]
        # A number at the very end orders names of different words, as `left1`, `right2`.
        if len(set(last)) > 1 and not any(parts[-1] for parts in names):
            return last
        if len(set(last)) in {1, len(last)} or is_given:
            return None
        raise InputError(_refusal(paths, "different words have the same numbers"))
    columns = _with_fractions(list(zip(*[parts[1::2] for parts in names], strict=True)))
    # One image has no column that varies, and takes its last number.
    varying = [column for column in columns if len(set(column)) > 1] or columns[-1:]
    # Times since 1970 before others: a counter beside them says less.
    # The last of those that vary: counters stand behind what they count in.
    chosen = next((column for column in varying if epoch_unit(column)), varying[-1])
    # Other numbers that change may only grow along, as of parts of one video.
    rows = sorted(zip(chosen, *varying, strict=True))
    is_increasing = all(
        before[0] < after[0] and all(map(le, before, after)) for before, after in pairwise(rows)
    )
    if len(varying) == 1 or is_increasing:
        return chosen
    if is_given:
        return None
    raise InputError(_refusal(paths, "several numbers in them change, and not together"))


def _with_fractions(columns: list[tuple[str, ...]]) -> list[list[Numeral]]:
    """Read columns of digits; seconds since 1970 and a fraction that follows them become one."""
    read: list[list[Numeral]] = []
    for column in columns:
        numbers = [_numeral(digits) for digits in column]
        if read and _is_fraction_of(read[-1], column):
            seconds = [integer for integer, _ in read[-1]]
            read[-1] = list(zip(seconds, column, strict=True))
        else:
            read.append(numbers)
    return read


def _is_fraction_of(seconds: Sequence[Numeral], column: Sequence[str]) -> bool:
    widths = {len(digits) for digits in column}
    is_whole = not any(fraction for _, fraction in seconds)
    # Columns of one width only: a shorter one has lost leading zeros, and with them its unit.
    is_even = len(widths) == 1 and widths <= _FRACTION_WIDTHS
    return is_whole and is_even and epoch_unit(seconds) == "s"


def _numeral(digits: str) -> Numeral:
    integer, _, fraction = digits.partition(".")
    return int(integer), fraction
