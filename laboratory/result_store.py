# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Results on disk, added one by one, so that interrupted work continues."""

from __future__ import annotations

import contextlib
import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any, TypeAlias

from vehicle_pf_tracker.core.outputs import output_errors
from vehicle_pf_tracker.results.output_files import make_folder

Result: TypeAlias = dict[str, Any]
"""Plain values that JSON knows."""


class ResultStore:
    """A file with one line of JSON for each result.

    A line that a killed run left unfinished, or that is no result, is dropped. Lines under keys
    that are no longer requested stay; deleting the file only costs their time.

    Parameters
    ----------
    path : Path
        The file; made, with its folder, where it is missing.

    Raises
    ------
    InputError
        If it cannot be read or written; also from `add`.
    """

    def __init__(self, path: Path) -> None:
        make_folder(path.parent)
        self._path = path
        with output_errors(path):
            self._results = dict(_read(path))

    def __contains__(self, key: str) -> bool:
        return key in self._results

    def __getitem__(self, key: str) -> Result:
        return self._results[key]

    def add(self, key: str, label: str, result: Result) -> None:
        """Keep `result` under `key`; `label` is for those who look into the file."""
        line = json.dumps({"key": key, "label": label, "result": result}, allow_nan=False)
        with output_errors(self._path), self._path.open("a", encoding="utf-8") as file:
            file.write(line + "\n")
            file.flush()
            # On the disk before the next run begins: a power failure costs one result.
            os.fsync(file.fileno())
        # As read back, so that a result is the same whether it was made now or before.
        self._results[key] = json.loads(line)["result"]


def _read(path: Path) -> Iterator[tuple[str, Result]]:
    if not path.exists():
        return
    # What follows the last newline was being written when the run was killed.
    whole, newline, unfinished = path.read_bytes().rpartition(b"\n")
    if unfinished:
        os.truncate(path, len(whole) + len(newline))
    for line in whole.splitlines():
        # A line that is damaged is computed again.
        with contextlib.suppress(ValueError, KeyError, TypeError, RecursionError):
            entry = json.loads(line)
            yield entry["key"], entry["result"]
