# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`synth`: render a synthetic scene to a recording or a video."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import astuple, dataclass
from pathlib import Path

from vehicle_pf_tracker.cli.console import UsageError, counting
from vehicle_pf_tracker.cli.option_values import NameChoices
from vehicle_pf_tracker.cli.requests import option, positional, switch
from vehicle_pf_tracker.cli.shared_options import OverwriteOption
from vehicle_pf_tracker.core.errors import InputError, suggestion
from vehicle_pf_tracker.core.outputs import claimed
from vehicle_pf_tracker.parameters.table import specs
from vehicle_pf_tracker.recordings.bags.writer import RecordingWriter
from vehicle_pf_tracker.results.output_files import write_csv
from vehicle_pf_tracker.scenes.catalogue import SCENES, make_scene
from vehicle_pf_tracker.scenes.scene import Scene
from vehicle_pf_tracker.showing.video_file import VIDEO_SUFFIX, video_writer


@dataclass(frozen=True, kw_only=True)
class Request(OverwriteOption):
    """Request of `synth`."""

    scene: str | None = positional(
        nargs="?", choices=NameChoices(tuple(SCENES)), metavar="SCENE",
        help=f"one of: {', '.join(SCENES)}",
    )  # fmt: skip
    out: Path | None = positional(
        nargs="?", metavar="OUT",
        help="rosbag2 folder to write; or a video, NAME.mp4, with its truth in NAME.csv",
    )  # fmt: skip
    list: bool = switch(help="list the scenes and their settings")
    seed: int = option(default=0, help="changes textures, noise and traffic (default: 0)")
    settings: Sequence[str] = option(
        "--set", action="append", default=[], metavar="NAME=VALUE",
        help="set a setting of the scene; repeatable",
    )  # fmt: skip


def run(request: Request) -> int:
    """Render the scene, and print a summary."""
    if request.list:
        print("\n".join(_listing()))
        return 0
    if request.scene is None or request.out is None:
        raise UsageError("synth needs SCENE and OUT; `synth --list` shows the scenes")
    if request.scene not in SCENES:
        raise InputError(
            f"there is no scene {request.scene!r}{suggestion(request.scene, SCENES)}; choose one "
            f"of {', '.join(SCENES)}; turns and the scenes with many vehicles are written by "
            "`python -m laboratory.scenes SCENE OUT` in a clone of the repository"
        )
    scene = make_scene(request.scene, seed=request.seed, settings=request.settings)
    facts = (
        f"{request.out}: {scene.frame_count} frames of {scene.width}x{scene.height} px "
        f"at {scene.frame_rate:g} frames/s"
    )
    if request.out.suffix != VIDEO_SUFFIX:
        with claimed([request.out], [], overwrite=request.overwrite):
            record_scene(scene, request.out, overwrite=request.overwrite)
        print(f"{facts}, all with truth")
        return 0
    table = _film(scene, request.out, overwrite=request.overwrite)
    target = ",".join(f"{value:.0f}" for value in astuple(scene.truth(0).box))
    print(f"{facts}; the truth is in {table}, and begins with --target {target}")
    return 0


def record_scene(scene: Scene, out: Path, *, overwrite: bool = False) -> None:
    """Render `scene` into the rosbag2 folder `out`, with truth, as pixels; shows progress.

    Raises
    ------
    InputError
        If the folder is not empty, or cannot be written.
    """
    with RecordingWriter(out, overwrite=overwrite) as writer, counting("rendered") as progress:
        for number, rendered in enumerate(scene.frames(), start=1):
            writer.write_image(rendered.truth.stamp_ns, rendered.frame)
            writer.write_truth(rendered.truth)
            progress(number, scene.frame_count)


def _film(scene: Scene, out: Path, *, overwrite: bool) -> Path:
    """Render `scene` into a video, and its truth into a table, whose path is returned."""
    table = out.with_suffix(".csv")
    size = (scene.width, scene.height)
    rows = []
    with claimed([out, table], [], overwrite=overwrite):
        with video_writer(out, size, scene.frame_rate) as write, counting("rendered") as progress:
            for number, rendered in enumerate(scene.frames(), start=1):
                write(rendered.frame, (number - 1) / scene.frame_rate)
                sides = (f"{value:.3f}" for value in astuple(rendered.truth.box))
                rows.append([number, *sides, rendered.truth.occlusion.value])
                progress(number, scene.frame_count)
        write_csv(table, ("frame", "x", "y", "w", "h", "occ"), rows)
    return table


def _listing() -> Iterator[str]:
    for name, kind in SCENES.items():
        yield f"{name}: {kind.summary}"
        for spec in specs(kind.parameters).values():
            facts = filter(None, (spec.unit, spec.bounds_text, " | ".join(spec.choices)))
            yield f"  {spec.name}={spec.default} [{', '.join(facts)}]: {spec.doc}"
