# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Figures in files."""

from __future__ import annotations

from pathlib import Path

from matplotlib import rc_context
from matplotlib.figure import Figure

from vehicle_pf_tracker.results.output_files import replacing

_DPI = 150
"""Dots per inch: figures are sharp on a screen at the width of a page."""


def save(figure: Figure, path: Path) -> None:
    """Write `figure` to the file `path`, whose suffix names the format.

    The same figure gives the same file: no date is written, and names within it are not random.

    Raises
    ------
    InputError
        If it cannot be written.
    """
    # Only SVG files state a date.
    metadata = {"Date": None} if path.suffix == ".svg" else {}
    with replacing(path) as partial, rc_context({"svg.hashsalt": "vehicle_pf_tracker"}):
        figure.savefig(partial, dpi=_DPI, metadata=metadata)
