# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Command lines of the programs that run `fusion` over sequences."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

NUMBERS = {
    "budget": (48, "settings that are tried"),
    "cases": (3, "cases of each sequence to fit to"),
    "seeds": (5, "seeds of the plain sequences"),
    "hard": (6, "hard cases of each sequence to judge"),
}
"""Options of the programs that fit or judge: default and help."""


def make_parser(purpose: str | None, *numbers: str) -> argparse.ArgumentParser:
    """Make the parser of a program over sequences with some of `NUMBERS` as options."""
    parser = argparse.ArgumentParser(description=(purpose or "").partition("\n")[0])
    parser.add_argument(
        "sequences", type=Path, nargs="+", help="folders of recordings or frame folders"
    )
    parser.add_argument("--cameras", type=Path, default=Path("benchmarks/cameras.csv"))
    for name in numbers:
        default, text = NUMBERS[name]
        parser.add_argument(f"--{name}", type=int, default=default, help=text)
    parser.add_argument("--seed", type=int, default=0, help="seed of all that is drawn")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("-o", "--output", type=Path, required=True)
    return parser


def parsed(parser: argparse.ArgumentParser) -> argparse.Namespace:
    """Read the command line, and make the folder of the results."""
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    return options


def report_progress(done: int, total: int | None) -> None:
    """Tell how many runs are done, now and then."""
    if done % 50 == 0 or done == total:
        print(f"{done} of {total} runs", file=sys.stderr, flush=True)
