# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Parameter files and recordings that were damaged, read by commands and by a node.

A parameter file must be refused with a sentence, or give exactly the values that it names, both to
the command line and to a node. A recording must be refused with one line and status 1, or tracked
with a row for each of its images, and with a word about what is missing.
"""

from __future__ import annotations

import contextlib
import csv
import faulthandler
import io
import os
import random
import shutil
import tempfile
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import rclpy
from mcap.writer import CompressionType

from laboratory.faults.damage import spoil_bytes, spoil_text
from laboratory.faults.drive import FIRST_NS, PERIOD_NS, TARGET_BOX, Drive
from laboratory.faults.node_process import FaultError
from vehicle_pf_tracker.cli.main import main as command
from vehicle_pf_tracker.cli.params import default_yaml
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.parameters.files import read_yaml, read_yaml_file
from vehicle_pf_tracker.recordings.bags.writer import RecordingWriter
from vehicle_pf_tracker.ros.node.tracker_node import TrackerNode
from vehicle_pf_tracker.ros.rclpy_internals import RCLError, UnknownROSArgsError
from vehicle_pf_tracker.trackers.registry import find_variant

VARIANT = find_variant("pf")
FRAMES = 12
"""Images of the recordings: enough for a start and a few steps."""
LONGEST = 30
"""Seconds that reading a file may take: a stack trace then ends the process."""


def try_parameters(path: Path, _: Path) -> str:
    """Read a parameter file as `run` does, then as a node does; return what came of it."""
    by_command_line = _in_python(path)
    by_node = _in_node(path)
    return f"{by_command_line} by the command line, {by_node} by the node"


def _in_python(path: Path) -> str:
    try:
        values = read_yaml(path, "pf_tracker")
        given = Configuration.of(VARIANT).updated(values).to_mapping()
    except InputError:
        return "refused"
    # Names that the command line passes over on purpose are no fault; other values are.
    wrong = {
        name: value for name, value in values.items() if name in given and given[name] != value
    }
    if wrong:
        raise FaultError(f"taken for other values: {wrong}")
    return "taken"


def _in_node(path: Path) -> str:
    context = rclpy.Context()
    node = None
    try:
        read_yaml_file(path, "parameter file")  # as the node's program does first
        with _quiet():
            rclpy.init(args=["--ros-args", "--params-file", str(path)], context=context)
            node = TrackerNode(VARIANT, context=context)
        parameters = node.get_parameters_by_prefix("")
        given = {name: parameter.value for name, parameter in parameters.items()}
        wrong = {
            name: value
            for name, value in node.overrides.items()
            if name in given and given[name] != value
        }
        if wrong:
            raise FaultError(f"the node has other values than {wrong}")
    except (InputError, RCLError, UnknownROSArgsError):
        return "refused"
    else:
        return "taken"
    finally:
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown(context=context)


def try_recording(path: Path, folder: Path) -> str:
    """Track a recording; return what came of it."""
    out = folder / "out"
    # Of the file before: a folder that is not empty would be refused for that.
    shutil.rmtree(out, ignore_errors=True)
    target = ",".join(map(str, TARGET_BOX))
    # Few particles: it is the reading that is tested.
    words = ["run", str(path), "--variant", "pf", "--set", "num_particles=20"]
    with _captured() as (printed, errors):
        status = command([*words, "--target", target, "-o", str(out)])
    complaint = errors.getvalue()
    if status == 1 and complaint.strip() and "Traceback" not in complaint:
        return "refused"
    if status != 0:
        raise FaultError(f"status {status}: {complaint}")
    with (out / "estimates.csv").open() as file:
        rows = list(csv.DictReader(file))
    # Fewer rows need a word; all of them need none.
    if not rows or (len(rows) != FRAMES and not complaint.strip()):
        raise FaultError(f"{len(rows)} rows of {FRAMES} without a word: {printed.getvalue()}")
    return "tracked whole" if len(rows) == FRAMES else "tracked in part, and said so"


@contextlib.contextmanager
def _captured() -> Iterator[tuple[io.StringIO, io.StringIO]]:
    printed = io.StringIO()
    errors = io.StringIO()
    with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(errors):
        yield printed, errors


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """Keep what C libraries write from the terminal."""
    # By the file descriptor: C libraries do not write through Python's `sys.stderr`.
    kept = os.dup(2)
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 2)
    try:
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)
        os.close(nowhere)


def recording(folder: Path, compression: CompressionType) -> bytes:
    """Make a small recording; return its MCAP file."""
    drive = Drive()
    with RecordingWriter(folder, compression=compression) as writer:
        for number in range(FRAMES):
            writer.write_image(FIRST_NS + number * PERIOD_NS, np.array(drive.frame(number)))
    return next(folder.glob("*.mcap")).read_bytes()


def give_files(kind: str, count: int, seed: int) -> bool:
    """Give damaged files of a kind, ``parameters`` or ``recordings``; print what came of them.

    Raises
    ------
    FaultError
        At the first that is not dealt with as it should be; that file is kept.
    """
    draw = random.Random(seed)
    results = Counter[str]()
    with tempfile.TemporaryDirectory(prefix="faults_") as folder:
        make, judge, suffix = _kinds(Path(folder))[kind]
        path = Path(folder, f"fuzzed{suffix}")
        for number in range(count):
            path.write_bytes(make(draw))
            # By a thread in C: Python's own timers cannot end a loop in a library.
            faulthandler.dump_traceback_later(LONGEST, exit=True)
            try:
                results[judge(path, Path(folder))] += 1
            # Whatever it was: the file that caused it is worth more than a tidy folder.
            except BaseException as error:
                kept = Path(tempfile.gettempdir(), f"fuzzed_{number}{suffix}")
                shutil.copy(path, kept)
                raise FaultError(f"{kept}: {type(error).__name__}: {error}") from error
            faulthandler.cancel_dump_traceback_later()
    print(f"{kind}: {count} files, seed {seed}")
    for result, times in results.most_common():
        print(f"  {result}: {times}")
    return True


def _kinds(
    folder: Path,
) -> dict[str, tuple[Callable[[random.Random], bytes], Callable[[Path, Path], str], str]]:
    """Return how files of each kind are made and judged, and how their names end."""
    text = default_yaml(VARIANT)
    # In each way to pack a chunk, as each has a reader of its own.
    whole = [recording(folder / kind.name, kind) for kind in CompressionType]
    return {
        "parameters": (lambda draw: spoil_text(text, draw), try_parameters, ".yaml"),
        "recordings": (lambda draw: spoil_bytes(draw.choice(whole), draw), try_recording, ".mcap"),
    }
