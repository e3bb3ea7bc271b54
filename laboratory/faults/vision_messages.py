# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""vision_msgs, which robots have and test machines need not: imported, or built for the run."""

from __future__ import annotations

import contextlib
import io
import os
import sys
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any


def vision_messages(folder: Path) -> Any:
    """Import vision_msgs.msg, built in `folder` from its definitions where it is not installed."""
    if find_spec("vision_msgs") is None:
        # Built by the tests' helper: vision_msgs is not installed everywhere.
        sys.path.append(str(Path(__file__).resolve().parents[2] / "test" / "ros"))
        built = import_module("built_messages")
        with contextlib.redirect_stdout(io.StringIO()):  # each file that is written
            path = str(built.build("vision_msgs", built.VISION, folder))
        sys.path.append(path)
        # For the node's process.
        known = os.environ.get("PYTHONPATH")
        os.environ["PYTHONPATH"] = os.pathsep.join([path, *([known] if known else [])])
    return import_module("vision_msgs.msg")
