# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Put the licence's header at the top of every Python file that lacks it.

`python -m tools.licence_headers`. It is the short form: a copyright line and an SPDX identifier.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

from tools import ROOT

FOLDERS = (
    "vehicle_pf_tracker",
    "benchmarks",
    "laboratory",
    "launch",
    "reproduction",
    "requirements",
    "test",
    "tools",
)
"""Folders whose files have the header."""

HEADER = """\
# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""


def without_header(root: Path = ROOT) -> Iterator[Path]:
    """Find the Python files that are not empty and do not begin with the header."""
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*.py")):
            text = path.read_text(encoding="utf-8")
            if text and not text.startswith(HEADER):
                yield path


def with_header(text: str) -> str:
    """Return `text` with the header at its top, once; one without the empty line gets that."""
    return HEADER + text.removeprefix(HEADER.rstrip("\n")).lstrip("\n")


def main() -> int:
    """Add the header where it is missing."""
    for path in list(without_header()):
        path.write_text(with_header(path.read_text(encoding="utf-8")), encoding="utf-8")
        print(f"added to {path.relative_to(ROOT)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
