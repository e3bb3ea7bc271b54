# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Nodes as processes, what they cost, and what they keep in memory."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import threading
import time
from collections import deque
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import IO

import yaml

from benchmarks.bench.material import drive
from benchmarks.bench.metered_node import METER_RECORD
from benchmarks.bench.resident import resident_mb
from benchmarks.bench.root import ROOT
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.workers.processes import wait_or_kill

_READY = "ready:"
"""Beginning of the line in which a node says that it is ready."""
_SIDES = ("x", "y", "width", "height")
"""Parameters of a target."""


class NodeProcess:
    """A node in a process of its own; returns from its constructor once the node is ready.

    Parameters
    ----------
    words : sequence of str
        Module or script that Python runs, with arguments.
    environment : mapping
        Variables over those of this process.

    Raises
    ------
    InputError
        If it ends before it is ready.
    """

    def __init__(self, words: Sequence[str], environment: Mapping[str, str] | None = None) -> None:
        # A file: nobody reads it while the node runs, and a full pipe would stop it.
        self._log = tempfile.TemporaryFile("w+")  # noqa: SIM115 - open as long as the process
        variables = {**os.environ, **(environment or {})}
        self._process = subprocess.Popen(
            [sys.executable, *words],
            env=variables,
            cwd=ROOT,
            stdout=self._log,
            stderr=subprocess.PIPE,
            text=True,
        )
        assert self._process.stderr is not None
        self._reader: threading.Thread | None = None
        said = []
        # Line by line until it is ready; a node that ends before has closed its stream.
        for line in self._process.stderr:
            said.append(line)
            if _READY in line:
                # Read on for as long as it runs: a full pipe would stop it.
                self._reader = threading.Thread(
                    target=_discard, args=[self._process.stderr], daemon=True
                )
                self._reader.start()
                return
        self.end()
        raise InputError(f"the node {' '.join(words)} ended at once: {''.join(said)[-2000:]}")

    @property
    def pid(self) -> int:
        """Number of the process."""
        return self._process.pid

    @property
    def cpu_seconds(self) -> float:
        """CPU time of the whole process so far, of all its threads."""
        return time.clock_gettime((~self._process.pid << 3) | 2)  # Linux: CPU clock of a process

    @property
    def resident_mb(self) -> float:
        """Resident memory in MB, shared libraries included."""
        return resident_mb(self._process.pid)

    def end(self) -> None:
        """End the process."""
        # Asked first, and killed if it does not answer.
        self._process.terminate()
        wait_or_kill(self._process)
        if self._reader is not None:
            self._reader.join()
        assert self._process.stderr is not None
        self._process.stderr.close()
        self._log.close()

    def __enter__(self) -> NodeProcess:
        return self

    def __exit__(self, *failure: object) -> None:
        self.end()


def _discard(stream: IO[str]) -> None:
    """Read a stream to its end, and keep nothing of it."""
    deque(stream, maxlen=0)


class StepMeter:
    """Cost of a metered node's steps so far."""

    def __init__(self) -> None:
        self._file = tempfile.NamedTemporaryFile()  # noqa: SIM115 - as long as this object
        self._file.write(METER_RECORD.pack(0.0, 0.0))
        # Zeros before the node starts: it may be read before the first step.
        self._file.flush()

    @property
    def path(self) -> str:
        """File that the node writes it to."""
        return self._file.name

    @property
    def cpu_seconds(self) -> float:
        """CPU seconds of all steps."""
        return float(METER_RECORD.unpack(Path(self.path).read_bytes())[0])


def floor_words(image: str) -> list[str]:
    """Words that run the floor on the topic `image`."""
    return ["-m", "benchmarks.bench.floor_node", "--ros-args", "-r", f"image:={image}"]


def tracker_words(
    variant: str, image: str, meter: StepMeter | None = None, **parameters: object
) -> list[str]:
    """Words that run the node of `variant` on the drive's vehicle; `__` in a name is a dot."""
    code = "from vehicle_pf_tracker.ros.executables import main"
    words = ["-c", f"{code}; raise SystemExit(main({variant!r}))"]
    if meter is not None:
        words = ["-m", "benchmarks.bench.metered_node", meter.path, variant]
    box = drive().boxes[0]
    # Floats, as a parameter of a node has one type.
    values: dict[str, object] = {
        **{f"target.{name}": float(getattr(box, name)) for name in _SIDES},
        **{name.replace("__", "."): value for name, value in parameters.items()},
    }
    given = [word for name, value in values.items() for word in ("-p", f"{name}:={value}")]
    return [*words, "--ros-args", "-r", f"image:={image}", *given]


def container_words(variant: str, images: Sequence[str], path: Path) -> list[str]:
    """Words that run a node of `variant` for each topic, all in one process; writes `path`."""
    box = drive().boxes[0]
    target = [float(getattr(box, name)) for name in _SIDES]
    entries = {
        image.rpartition("/")[2]: {"variant": variant, "topic": image, "target": [*target]}
        for image in images
    }
    path.write_text(yaml.safe_dump({"cameras": entries}), encoding="utf-8")
    code = "from vehicle_pf_tracker.ros.executables import main; raise SystemExit(main('vehicle'))"
    return ["-c", code, "--cameras", str(path), "--ros-args", "-p", "queue_depth:=10"]
