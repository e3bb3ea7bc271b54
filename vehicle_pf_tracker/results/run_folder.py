# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The folder with the results of one run: `estimates.csv`, `metrics.json` and `run.json`."""

from __future__ import annotations

import platform
from collections.abc import Mapping, Sequence
from datetime import datetime, timezone
from importlib import metadata
from pathlib import Path
from types import MappingProxyType
from typing import Any

import cv2
import numpy as np

from vehicle_pf_tracker.core.addresses import shown_values
from vehicle_pf_tracker.core.outputs import output_errors
from vehicle_pf_tracker.core.version import installed_version
from vehicle_pf_tracker.parameters.table import to_mapping
from vehicle_pf_tracker.results.estimates import EstimateRow, write_estimates
from vehicle_pf_tracker.results.output_files import make_folder, write_json
from vehicle_pf_tracker.trackers.session import Session

ESTIMATES_FILE = "estimates.csv"
"""File of the estimates, a row for each frame."""
METRICS_FILE = "metrics.json"
"""File of the scores, where there is truth."""
RUN_FILE = "run.json"
"""File of what ran: source, parameters, seed, versions."""


def describe_target_run(
    session: Session,
    start_frame: int | None,
    command: Sequence[str],
    source: str,
    topic: str,
    notices: Sequence[str],
) -> dict[str, Any]:
    """Make the content of `run.json` for the run of one target; see `describe_run`.

    `seed` is the one in use: the drawn one where the parameter `seed` is -1; `kernels` likewise
    those that `auto` chose.
    """
    tracker = session.tracker
    box = session.settings.target.box
    return {
        **describe_run(
            command,
            source,
            topic,
            notices,
            variant=session.variant.name,
            seed=tracker.seed,
            parameters={**to_mapping(tracker.parameters), **to_mapping(session.settings)},
        ),
        "kernels": tracker.kernels.name,
        "target": None if box is None else [box.x, box.y, box.width, box.height],
        "start_frame": start_frame,
    }


def describe_run(
    command: Sequence[str], source: str, topic: str, notices: Sequence[str], **facts: Any
) -> dict[str, Any]:
    """Make the part of `run.json` that every run has, without passwords of addresses.

    Parameters
    ----------
    command : sequence of str
        Command line; empty where there was none.
    source, topic : str
        Source of the images; the topic is empty where frames came from memory.
    notices : sequence of str
        Irregularities, a sentence each.
    **facts : Any
        What ran, with its seed and parameters.
    """
    document: dict[str, Any] = {
        "command": list(command),
        "made": datetime.now(timezone.utc).isoformat(timespec="seconds"),
        "host": platform.node(),
        "recording": source,
        "image_topic": topic,
        **facts,
        "versions": versions(),
        "notices": list(notices),
    }
    return {name: shown_values(value) for name, value in document.items()}


def versions() -> dict[str, str | None]:
    """Return the versions that determine the numbers; None for packages not installed."""
    numba = next(iter(metadata.distributions(name="numba")), None)
    return {
        "vehicle_pf_tracker": installed_version(),
        "python": platform.python_version(),
        "numpy": np.__version__,
        "opencv": cv2.__version__,
        "numba": numba and numba.version,
        "platform": platform.platform(),
    }


def write_run(
    folder: Path,
    rows: Sequence[EstimateRow],
    description: Mapping[str, Any],
    extra: Mapping[str, Sequence[float | None]] = MappingProxyType({}),
) -> None:
    """Write `estimates.csv` with the columns `extra`, and the description to `run.json`.

    The folder is made where it is missing; no result of an earlier run is left beside these.

    Raises
    ------
    InputError
        If nothing can be written there.
    """
    make_folder(folder)
    for name in (ESTIMATES_FILE, METRICS_FILE, RUN_FILE):
        with output_errors(folder / name):
            (folder / name).unlink(missing_ok=True)
    write_estimates(folder / ESTIMATES_FILE, rows, extra)
    write_json(folder / RUN_FILE, description)
