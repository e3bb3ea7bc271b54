# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Steps of this version against those of another commit: `python -m benchmarks.versus COMMIT`.

    python -m benchmarks.versus v1.0.0 --variants apf fusion --passes 5
    python -m benchmarks.versus v1.0.0 --vehicles 10 60

The other commit's package is laid out in a cache folder, and runs in a process of its own with the
libraries of this environment, so that only our own code differs. Both processes follow the same
drawn vehicle, in turns of 10 frames whose order changes, and report the processor time of their
thread; with `--vehicles` `traffic` follows as many at once, in given boxes. A ratio above 1 means
that this version's step takes longer. Nothing is judged: what a change of a hot path costs is read
here, and stands in its commit.
"""

from __future__ import annotations

import argparse
import io
import json
import os
import shutil
import statistics
import subprocess
import sys
import tarfile
import tempfile
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any, cast

import numpy as np

from benchmarks.bench.case import interquartile_range
from benchmarks.bench.material import drive
from benchmarks.bench.root import ROOT
from benchmarks.bench.turns import TURN_FRAMES
from benchmarks.traffic_cost import SETTLED, made
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.image.kernels.interface import KERNEL_CHOICES
from vehicle_pf_tracker.trackers.registry import VARIANTS

WORKER = Path(__file__).with_name("versus_worker.py")
"""Program that steps one version; it is of this commit for both, and needs little of either."""
CACHE = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "vehicle_pf_tracker"
"""Folder of the other versions' files and compiled kernels, so that the next run is quick."""
_TOY_FRAMES = 21
"""Frames of a toy: a start and two turns, so that each version is the first to step in one."""
_TOY_VARIANTS = ("ms", "apf")
"""Variants of a toy: the quickest, and the one that has most to do beside its kernels."""


@dataclass(frozen=True)
class Ratio:
    """CPU time of this version's steps over that of the other one's.

    Attributes
    ----------
    variant : str
        Name of the variant.
    here_ms, there_ms : float
        Medians over the turns, ms a step.
    ratio : float
        Median over the turns of their ratios: above 1 this version is the slower one.
    spread : float
        Interquartile range of those ratios.
    """

    variant: str
    here_ms: float
    there_ms: float
    ratio: float
    spread: float

    @classmethod
    def of(cls, variant: str, here: Sequence[float], there: Sequence[float]) -> Ratio:
        """Sum up the turns: in each, seconds a step of this version and of the other one."""
        ratios = [own / other for own, other in zip(here, there, strict=True)]
        here_ms, there_ms = (1e3 * statistics.median(times) for times in (here, there))
        middle = statistics.median(ratios)
        return cls(variant, here_ms, there_ms, middle, interquartile_range(ratios))


class Worker:
    """A process that steps trackers of one version of the package; a context manager.

    Parameters
    ----------
    package : Path
        Folder that has the version's `vehicle_pf_tracker`.
    frames : Path
        File of frames and boxes, as `write_frames` makes it.
    """

    def __init__(self, package: Path, frames: Path) -> None:
        single = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1")
        self._process = subprocess.Popen(
            [sys.executable, str(WORKER), str(frames)],
            env={**os.environ, **single, "PYTHONPATH": str(package)},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def __enter__(self) -> Worker:
        """Use the process until the block ends."""
        return self

    def __exit__(self, *_: object) -> None:
        """End the process."""
        cast("IO[str]", self._process.stdin).close()
        self._process.wait()

    def ask(self, *words: object) -> Any:
        """Send one request, and return what the process answers.

        Raises
        ------
        InputError
            If the version cannot do it; the process has said why on stderr.
        """
        source = self._process.stdout
        sink = self._process.stdin
        assert source is not None
        assert sink is not None
        try:
            sink.write(json.dumps(words) + "\n")
            sink.flush()
            return json.loads(source.readline())
        except (BrokenPipeError, json.JSONDecodeError):
            raise InputError(f"the version failed at {' '.join(map(str, words))}") from None

    @property
    def variants(self) -> list[str]:
        """Names of the variants that the version has."""
        return list(self.ask("variants"))


def lay_out(commit: str, cache: Path) -> Path:
    """Lay out the package of a commit in the cache, once; return the folder that has it.

    Raises
    ------
    InputError
        If the repository has no such commit, or git is missing.
    """
    sha = _git("rev-parse", "--verify", "--quiet", f"{commit}^{{commit}}").decode().strip()
    folder = cache / "versus" / sha
    if not folder.exists():
        archive = _git("archive", sha, "vehicle_pf_tracker")
        folder.parent.mkdir(parents=True, exist_ok=True)
        # Under another name until it is whole: a killed run must not leave half a package.
        with tempfile.TemporaryDirectory(dir=folder.parent) as unfinished:
            with tarfile.open(fileobj=io.BytesIO(archive)) as packed:
                packed.extractall(Path(unfinished) / sha, filter="data")
            (Path(unfinished) / sha).rename(folder)
    return folder


def _git(*words: str) -> bytes:
    git = shutil.which("git")
    if git is None:
        raise InputError("git is needed to lay out another commit, and is not there")
    try:
        done = subprocess.run([git, *words], cwd=ROOT, capture_output=True, check=True)
    except subprocess.CalledProcessError as error:
        reason = error.stderr.decode(errors="replace").strip() or "there is no such commit"
        raise InputError(f"git {' '.join(words)}: {reason}") from None
    return done.stdout


def last_release() -> str | None:
    """Return the newest tag that this commit comes after; None without one."""
    try:
        return _git("describe", "--tags", "--abbrev=0").decode().strip()
    except InputError:
        return None


def write_frames(path: Path, count: int) -> int:
    """Write the first frames of the drawn drive, and its boxes; return their number."""
    shown, boxes = drive()
    sides = [(box.x, box.y, box.width, box.height) for box in boxes[:count]]
    np.savez(path, frames=np.stack(shown[:count]), boxes=np.array(sides))
    return len(sides)


def write_road(path: Path, vehicles: int, images: int) -> None:
    """Write the images of a road with so many vehicles at once, and the boxes of a detector."""
    road = made(vehicles, path.with_suffix(""), images)
    np.savez(path, frames=np.stack(list(road.frames())), boxes=road.detections["good"])


def compare(
    variant: str,
    workers: tuple[Worker, Worker],
    frames: int,
    passes: int,
    settings: Mapping[str, str | int],
) -> Ratio:
    """Step one variant in both versions, in turns.

    Parameters
    ----------
    variant : str
        Name that both versions have.
    workers : (Worker, Worker)
        This version and the other one.
    frames : int
        Number of frames of a pass.
    passes : int
        Number of passes over the frames, each with a seed of its own.
    settings : mapping
        Parameters over the defaults; the number of particles only where the variant has some.
    """
    times: tuple[list[float], list[float]] = ([], [])
    for seed in range(passes):
        for worker in workers:
            worker.ask("start", variant, {**settings, "seed": seed})
        take_turns(workers, range(1, frames), times)
    return Ratio.of(variant, *times)


def compare_traffic(
    road: Path, workers: tuple[Worker, Worker], settled: int, frames: int, passes: int
) -> Ratio:
    """Step `traffic` in both versions, in turns, where `frames` follow `settled` ones.

    Parameters
    ----------
    road : Path
        File of images and boxes, as `write_road` makes it; the ratio has its name.
    workers : (Worker, Worker)
        This version and the other one.
    settled : int
        Number of images before the first turn, in which vehicles are found.
    frames : int
        Number of images of the turns.
    passes : int
        Number of passes over all.
    """
    times: tuple[list[float], list[float]] = ([], [])
    for _ in range(passes):
        for worker in workers:
            worker.ask("start_traffic", str(road), settled)
        take_turns(workers, range(settled, settled + frames), times)
    return Ratio.of(road.stem, *times)


def take_turns(
    workers: tuple[Worker, Worker], frames: range, times: tuple[list[float], list[float]]
) -> None:
    """Let both step through frames in turns of `TURN_FRAMES`; add the seconds a step of each."""
    for turn, first in enumerate(frames[: len(frames) // TURN_FRAMES * TURN_FRAMES : TURN_FRAMES]):
        for side in (0, 1) if turn % 2 else (1, 0):
            times[side].append(workers[side].ask("step", first, TURN_FRAMES) / TURN_FRAMES)


def table(ratios: Sequence[Ratio], commit: str) -> str:
    """Lay the ratios out as lines of a table."""
    lines = [f"{'step of':14} {'here':>9} {commit[:12]:>12}   here / there"]
    for ratio in ratios:
        times = f"{ratio.here_ms:6.3f} ms {ratio.there_ms:9.3f} ms"
        lines.append(f"{ratio.variant:14} {times}   {ratio.ratio:.2f} +- {ratio.spread / 2:.2f}")
    return "\n".join(lines)


def main(arguments: Sequence[str] | None = None) -> int:
    """Compare the versions; 1 where one of them cannot be run."""
    args = _arguments(arguments)
    commit = args.commit or last_release() or args.otherwise
    if commit is None:
        print("versus: no commit is given, and no release has a tag; nothing is compared")
        return 0
    try:
        ratios = _compare_all(args, commit)
    except InputError as error:
        print(f"versus: {error}", file=sys.stderr)
        return 1
    print(table(ratios, commit))
    return 0


def _compare_all(args: argparse.Namespace, commit: str) -> list[Ratio]:
    there = lay_out(commit, args.cache)
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        frames = write_frames(folder / "frames.npz", args.frames)
        here, other = (
            stack.enter_context(Worker(package, folder / "frames.npz")) for package in (ROOT, there)
        )
        shared = [name for name in here.variants if name in other.variants]
        if unknown := [name for name in args.variants if name not in shared]:
            raise InputError(f"the two versions do not both have {', '.join(unknown)}")
        settings = {"kernels": args.kernels}
        if args.particles:
            settings["num_particles"] = args.particles
        both = here, other
        named = args.variants or ([] if args.vehicles else shared)
        ratios = [compare(name, both, frames, args.passes, settings) for name in named]
        settled = 1 if args.toy else SETTLED
        for count in args.vehicles:
            road = folder / f"traffic_{count}.npz"
            write_road(road, count, settled + args.frames - 1)
            ratios.append(compare_traffic(road, both, settled, args.frames - 1, args.passes))
            road.unlink()
        return ratios


def _arguments(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.versus", description=__doc__)
    parser.add_argument("commit", nargs="?", help="default: the last tag")
    parser.add_argument(
        "--otherwise", metavar="COMMIT", help="commit to compare with where there is no tag"
    )
    parser.add_argument("--variants", nargs="+", default=[], metavar="NAME", choices=VARIANTS)
    parser.add_argument(
        "--vehicles",
        nargs="+",
        type=int,
        default=[],
        metavar="N",
        help="`traffic`: so many at once",
    )
    parser.add_argument("--passes", type=int, default=3, help="passes over the drive")
    parser.add_argument("--frames", type=int, default=101, help="frames of a pass")
    parser.add_argument("--particles", type=int, default=0, help="0: each variant's own number")
    parser.add_argument(
        "--kernels", default="auto", choices=KERNEL_CHOICES, help="as the parameter"
    )
    parser.add_argument("--cache", type=Path, default=CACHE, help="folder for other versions")
    parser.add_argument(
        "--toy",
        action="store_true",
        help="two variants, two turns each, with kernels that need no compilation",
    )
    args = parser.parse_args(arguments)
    if args.toy:
        args.passes = 1
        args.frames = _TOY_FRAMES
        args.kernels = "opencv"
        args.variants = args.variants or ([] if args.vehicles else list(_TOY_VARIANTS))
    return args


if __name__ == "__main__":
    raise SystemExit(main())
