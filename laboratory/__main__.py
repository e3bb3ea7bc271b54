# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The command line of the laboratory: ``python -m laboratory VERB``, ``stress`` or ``faults``.

The programs beside it that fit and score have command lines of their own:
``python -m laboratory.fusion.fit --help``.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from laboratory.faults import command as faults
from laboratory.stress import command as stress
from vehicle_pf_tracker.cli.console import USAGE_STATUS
from vehicle_pf_tracker.cli.main import exit_status
from vehicle_pf_tracker.cli.requests import add_options, request_of

PROGRAM = "python -m laboratory"


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line `argv`, that of the process if None, and return the exit status."""
    # Kept as words: reports state the command that made them.
    words = sys.argv[1:] if argv is None else list(argv)
    return exit_status(lambda: _run(words), PROGRAM)


def _run(words: Sequence[str]) -> int:
    parser = argparse.ArgumentParser(prog=PROGRAM, description="Experiments on the trackers.")
    verbs = parser.add_subparsers(metavar="VERB", required=True)
    for module, kind, name, purpose in (
        (stress, stress.Request, "stress", "run systems over difficult cases made of recordings"),
        (faults, faults.Request, "faults", "give nodes and commands faults of all kinds"),
    ):
        verb = verbs.add_parser(name, help=purpose)
        add_options(verb, kind)
        verb.set_defaults(command=[PROGRAM, *words], verb=module, kind=kind)
    try:
        args = parser.parse_args(words)
    except SystemExit as ended:  # argparse has said all there is to say
        return ended.code if isinstance(ended.code, int) else USAGE_STATUS
    return int(args.verb.run(request_of(args.kind, args)))


if __name__ == "__main__":
    sys.exit(main())
