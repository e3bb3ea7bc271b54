# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Cases that `fusion` is fitted to or judged on, listed once for the same options."""

from __future__ import annotations

import argparse
import hashlib
import pickle
from collections.abc import Sequence

from laboratory.stress import Case, find_sequences, list_cases

HARD_KINDS = ("shifted_box", "wall", "lorry")
"""Kinds beside the plain one on which settings are judged: a start beside the vehicle, and painted
occluders that stand and that drive."""


def listed_cases(
    options: argparse.Namespace, name: str, kinds: Sequence[str], **limits: int
) -> list[Case]:
    """List cases, or read those that a run before listed by the same options: it takes a minute."""
    # Recordings that were added to a folder since do not show; they need another output.
    selection = (
        [str(folder.resolve()) for folder in options.sequences],
        options.cameras.read_text(encoding="utf-8"),
        tuple(kinds),
        options.seed,
        sorted(limits.items()),
    )
    digest = hashlib.sha256(repr(selection).encode()).hexdigest()[:8]
    path = options.output / f"{name}_{digest}.pickle"
    if not path.exists():
        sources = find_sequences(options.sequences, options.cameras)
        cases = list_cases(sources, kinds=kinds, seed=options.seed, **limits)
        path.write_bytes(pickle.dumps(cases))
    cases = pickle.loads(path.read_bytes())  # noqa: S301 - written by the run before
    return list(cases)


def judged_cases(options: argparse.Namespace) -> list[tuple[list[Case], Sequence[int]]]:
    """List the cases that settings are judged on, and with them the seeds to run them with."""
    # The plain kind is listed whole, the hard ones a few of each sequence.
    plain = listed_cases(options, "plain_cases", ("plain",))
    hard = listed_cases(options, "judged_cases", HARD_KINDS, per_sequence=options.hard)
    # Seeds on the plain sequences only: of the hard cases there are many.
    return [(plain, range(options.seeds)), (hard, range(1))]
