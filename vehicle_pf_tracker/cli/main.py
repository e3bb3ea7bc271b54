# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The command `vehicle-pf-tracker`: chooses a verb, turns errors into a sentence and a status."""

from __future__ import annotations

import argparse
import importlib
import os
import re
import sys
from collections.abc import Callable, Mapping, Sequence

from vehicle_pf_tracker.cli import console
from vehicle_pf_tracker.cli.missing_modules import check_extra, remedy
from vehicle_pf_tracker.cli.requests import add_options, request_of
from vehicle_pf_tracker.cli.stopping import SIGNALS_STATUS, Terminated, raising_terminated
from vehicle_pf_tracker.core.addresses import HIDDEN_MARK, shown
from vehicle_pf_tracker.core.errors import InputError, suggestion
from vehicle_pf_tracker.core.version import installed_version

VERBS: Mapping[str, tuple[str, str]] = {
    "demo": ("demo", "try everything on a synthetic scene: track, replay to a node, score"),
    "import": ("import_footage", "convert a video or a folder of images to a recording"),
    "synth": ("synth", "render a synthetic scene to a video or a recording, with exact truth"),
    "params": ("params", "print the parameters of a variant, as a file to edit"),
    "run": ("run", "track vehicles in a video, recording or stream, without ROS"),
    "traffic": ("traffic", "follow every vehicle in view, and count them at lines"),
    "pick": ("pick", "draw vehicles, counting lines and zones on a page, for run and traffic"),
    "evaluate": ("evaluate", "compare variants on recordings with truth, over seeds"),
    "merge": ("merge", "join the parts of an evaluation that ran on several machines"),
    "tune": ("tune", "search a variant's parameters on recordings, and validate them on others"),
    "report": ("report", "write the report of an evaluation again"),
    "replay": ("replay", "feed a recording to ROS nodes"),
    "set-target": ("set_target", "give a running ROS node its target"),
    "road": ("road", "calibrate a camera, for metres and km/h on the road"),
    "compile": ("compile_kernels", "compile the extra [numba] now, so that no start waits"),
}
"""Module in this package and one line of help, by verb."""


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line `argv`, that of the process if None, and return the exit status."""
    words = sys.argv[1:] if argv is None else argv
    try:
        with raising_terminated():
            return exit_status(lambda: _run(list(words)))
    except Terminated as ended:
        ended.end()
        return SIGNALS_STATUS + ended.number  # not reached unless the signal is blocked


def exit_status(action: Callable[[], int], program: str = console.PROGRAM_NAME) -> int:
    """Return the status of `action`, or print the error that ended it in one line."""
    try:
        status = action()
        sys.stdout.flush()
    except (InputError, console.UsageError, MemoryError) as error:
        is_full = isinstance(error, MemoryError)
        console.tell_error("there is not enough memory" if is_full else str(error), program)
        return console.USAGE_STATUS if isinstance(error, console.UsageError) else console.FAILED
    except ModuleNotFoundError as error:
        if (error.name or "").startswith(__package__.partition(".")[0]):
            raise  # a fault of ours, not something that is left to install
        console.tell_error(remedy(error.name or "of an unknown name"), program)
        return console.FAILED
    except KeyboardInterrupt:
        return console.INTERRUPTED
    except BrokenPipeError:
        # Python flushes once more at exit, and would complain about it.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return console.PIPE_CLOSED
    except OSError as error:
        where = f"{error.filename}: " if error.filename else ""
        console.tell_error(f"{where}{error.strerror or error}", program)
        return console.FAILED
    return status


def bag_replay(argv: Sequence[str] | None = None) -> int:
    """Run the command `bag_replay`, which is the verb `replay`."""
    return main(["replay", *(sys.argv[1:] if argv is None else argv)])


def _run(words: list[str]) -> int:
    try:
        args = make_parser(words).parse_args(_with_negative_boxes(words))
    except SystemExit as ended:  # argparse has said all there is to say
        return ended.code if isinstance(ended.code, int) else console.USAGE_STATUS
    check_extra(args.verb)
    status: int = args.module.run(request_of(args.module.Request, args))
    return status


def _with_negative_boxes(words: Sequence[str]) -> list[str]:
    """Join options with values as `-3,97,46,26`: a box that the left border cuts is no option."""
    joined: list[str] = []
    for word in words:
        is_box = re.match(r"-[\d.]+,", word) is not None
        if is_box and joined and joined[-1].startswith("--") and "=" not in joined[-1]:
            joined[-1] += f"={word}"
        else:
            joined.append(word)
    return joined


def _without_secrets(words: Sequence[str]) -> list[str]:
    """Return the words of a command without passwords in addresses, nor the token of a page."""
    hidden = [shown(word) for word in words]
    for index, word in enumerate(words):
        if word.startswith("--token="):
            hidden[index] = f"--token={HIDDEN_MARK}"
        elif index and words[index - 1] == "--token":
            hidden[index] = HIDDEN_MARK
    return hidden


def make_parser(words: Sequence[str] | None = None) -> argparse.ArgumentParser:
    """Make the parser, with the options of the verb that `words` ask for, or of all if None.

    No other verb is loaded, so that help is quick and nothing needs ROS but what uses it.
    All of them are for programs that write a shell's completion.
    """
    asked = next((word for word in words or () if not word.startswith("-")), None)
    if asked is not None and asked not in VERBS:
        raise console.UsageError(
            f"there is no verb {asked!r}{suggestion(asked, VERBS)}; the verbs are "
            f"{', '.join(VERBS)}"
        )
    parser = argparse.ArgumentParser(
        prog=console.PROGRAM_NAME,
        description="Follow vehicles in traffic video through occlusions.",
        epilog="`vehicle-pf-tracker VERB --help` has the options of a verb.",
    )
    parser.add_argument(
        "--version", action="version", version=f"{console.PROGRAM_NAME} {installed_version()}"
    )
    verbs = parser.add_subparsers(metavar="VERB", required=True)
    for name, (module_name, line) in VERBS.items():
        description = f"{line[0].upper()}{line[1:]}."
        verb = verbs.add_parser(name, help=line, description=description)
        if words is None or name == asked:
            module = importlib.import_module(f"vehicle_pf_tracker.cli.{module_name}")
            add_options(verb, module.Request)
            command = [console.PROGRAM_NAME, *_without_secrets(words or ())]
            verb.set_defaults(verb=name, module=module, command=command)
    return parser
