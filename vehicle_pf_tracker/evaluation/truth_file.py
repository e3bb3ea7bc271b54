"""`truth.csv`: the truth of a recording beside the runs that are scored by it."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping
from pathlib import Path

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.evaluation.output_files import write_text

COLUMNS = ("frame", "stamp_ns", "x", "y", "width", "height", "occlusion")


def write_truth(path: Path, truths: Mapping[int, Truth]) -> None:
    """Write truths by the number of their frame (top-left corner and size in px, every digit).

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    for frame, truth in sorted(truths.items()):
        box = map(repr, (truth.box.x, truth.box.y, truth.box.width, truth.box.height))
        writer.writerow([frame, truth.stamp_ns, *box, truth.occlusion.name.lower()])
    write_text(path, text.getvalue())


def read_truth(path: Path) -> dict[int, Truth]:
    """Read truths by the number of their frame.

    Raises
    ------
    InputError
        If there is no such file, or a line of it is not as `write_truth` writes it.
    """
    try:
        with path.open(newline="", encoding="utf-8") as stream:
            reader = csv.DictReader(stream)
            return dict(_row(path, reader.line_num, line) for line in _checked(path, reader))
    except OSError as error:
        raise InputError(f"cannot read the truth {path}: {error.strerror}") from error


def _checked(path: Path, reader: csv.DictReader[str]) -> csv.DictReader[str]:
    if tuple(reader.fieldnames or ()) != COLUMNS:
        raise InputError(f"the truth {path} must begin with the line {','.join(COLUMNS)}")
    return reader


def _row(path: Path, number: int, line: Mapping[str, str]) -> tuple[int, Truth]:
    try:
        box = Box(*(float(line[name]) for name in ("x", "y", "width", "height")))
        occlusion = Occlusion[line["occlusion"].upper()]
        return int(line["frame"]), Truth(int(line["stamp_ns"]), box, occlusion)
    except (KeyError, TypeError, ValueError) as error:
        raise InputError(f"line {number} of the truth {path} is broken: {error}") from error
