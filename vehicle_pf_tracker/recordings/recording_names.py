# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Sources by their names: recordings, URLs, and the command that converts other bags.

Without the readers: a node that only asks whether something is a recording has no MCAP.
"""

from __future__ import annotations

import os
from pathlib import Path

MCAP_SUFFIX = ".mcap"
"""Suffix of MCAP files."""
SQLITE_SUFFIX = ".db3"
"""Suffix of rosbag2's SQLite files."""
CONVERSION = "rosbags-convert --src {path} --dst converted --dst-storage mcap"
"""Command that converts a bag; it comes with `rosbags`, and so with this package."""


def is_recording(path: Path) -> bool:
    """Return whether `path` is a rosbag2 folder or a file of one, by its name and content."""
    # The name of a file is enough: whether it holds what it says is the reader's matter.
    return path.suffix in {MCAP_SUFFIX, SQLITE_SUFFIX} or (path / "metadata.yaml").exists()


def is_url(source: Path | str) -> bool:
    """Return whether a source is a URL: a file of that name, as ``a:/b.mp4``, is none."""
    # Path.exists raises for names that are too long, as URLs may be.
    return "://" in str(source) and not os.path.exists(source)  # noqa: PTH110
