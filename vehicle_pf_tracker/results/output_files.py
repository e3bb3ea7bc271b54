# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Result files that appear whole or not at all."""

from __future__ import annotations

import csv
import io
import json
import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeVar

import cv2

from vehicle_pf_tracker.core.errors import InputError, read_text
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.core.outputs import output_errors

RowT = TypeVar("RowT")

PICTURES = (".png", ".jpg", ".jpeg")
"""Endings of pictures that are written."""


def make_folder(path: Path) -> Path:
    """Make the folder `path` where it is missing.

    Raises
    ------
    InputError
        If it is a file, or may not be made.
    """
    with output_errors(path):
        if path.exists() and not path.is_dir():
            raise InputError(f"the output {path} is a file; name a folder")
        path.mkdir(parents=True, exist_ok=True)
    return path


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Yield a path beside `path` to write to; it takes the place of `path` if all goes well.

    Raises
    ------
    InputError
        If it cannot be written.
    """
    # The suffix stays, since those who draw pictures choose the format by it.
    partial = path.with_name(f".{path.stem}.{os.getpid()}.partial{path.suffix}")
    with output_errors(path):
        try:
            yield partial
            flush(partial)
            partial.replace(path)
            flush(path.parent)
        finally:
            partial.unlink(missing_ok=True)


def write_text(path: Path, text: str) -> None:
    """Write `text` in one go; see `replacing`."""
    with replacing(path) as partial:
        partial.write_text(text, encoding="utf-8", newline="\n")


def csv_text(header: Sequence[str], rows: Iterable[Iterable[object]]) -> str:
    """Return the text of a CSV file, with every digit, and an empty cell for None."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(header)
    writer.writerows(rows)
    return text.getvalue()


def write_csv(path: Path, header: Sequence[str], rows: Iterable[Iterable[object]]) -> None:
    """Write a table in one go; see `csv_text`."""
    write_text(path, csv_text(header, rows))


def read_csv(
    path: Path, what: str, header: Sequence[str], row: Callable[[Mapping[str, str]], RowT]
) -> list[RowT]:
    """Read a table that begins with the columns `header`, and make a `row` of each line.

    `what` names it in errors, as ``the truth``.

    Raises
    ------
    InputError
        If there is no such file, it begins with other columns, or a line of it makes no row.
    """
    lines = csv.DictReader(read_text(path, what).splitlines())
    if tuple(lines.fieldnames or ())[: len(header)] != tuple(header):
        raise InputError(f"{what} {path} must begin with the line {','.join(header)}")
    try:
        return [row(line) for line in lines]
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        raise InputError(f"line {lines.line_num} of {what} {path} is broken: {error}") from error


def write_picture(path: Path, picture: Frame) -> None:
    """Write an RGB picture as the kind of file that its name says.

    Raises
    ------
    InputError
        If it is neither PNG nor JPEG by its name, or cannot be written.
    """
    if path.suffix.lower() not in PICTURES:
        raise InputError(f"the picture {path} must end in {' or '.join(PICTURES)}")
    make_folder(path.parent)
    _, coded = cv2.imencode(path.suffix.lower(), cv2.cvtColor(picture, cv2.COLOR_RGB2BGR))
    with replacing(path) as partial:
        partial.write_bytes(coded.tobytes())


def write_json(path: Path, document: Any) -> None:
    """Write `document` as JSON, refusing numbers that JSON does not have."""
    text = json.dumps(document, indent=2, ensure_ascii=False, allow_nan=False)
    write_text(path, text + "\n")


def flush(path: Path) -> None:
    """Wait until a file, or the names in a folder, are on the disk: a rename may outrun them."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
