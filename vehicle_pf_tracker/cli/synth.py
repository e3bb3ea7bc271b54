# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""`synth`: render a synthetic scene to a recording with exact truth."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path

from vehicle_pf_tracker.cli.console import UsageError
from vehicle_pf_tracker.cli.progress import counting
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.parameters.table import specs
from vehicle_pf_tracker.recordings.importing import FORMATS, jpeg
from vehicle_pf_tracker.recordings.writer import RecordingWriter
from vehicle_pf_tracker.scenes.catalogue import SCENES, make_scene
from vehicle_pf_tracker.scenes.scene import Scene


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of this verb."""
    add = parser.add_argument
    add("scene", nargs="?", metavar="SCENE", help=f"one of: {', '.join(SCENES)}")
    add("out", nargs="?", type=Path, metavar="OUT", help="rosbag2 folder to write")
    add("--list", action="store_true", help="list the scenes and their settings")
    add("--seed", type=int, default=0, help="changes textures, noise and traffic (default: 0)")
    add(
        "--set", action="append", default=[], metavar="NAME=VALUE", dest="settings",
        help="set a setting of the scene; repeatable",
    )  # fmt: skip
    add(
        "--format", choices=FORMATS, default="raw",
        help="pixels, or JPEG files (default: raw)",
    )  # fmt: skip
    add("--overwrite", action="store_true", help="overwrite an existing recording")


def run(args: argparse.Namespace) -> int:
    """Render the scene, and print a summary of the recording."""
    if args.list:
        print("\n".join(_listing()))
        return 0
    if args.scene is None or args.out is None:
        raise UsageError("synth needs SCENE and OUT; `synth --list` shows the scenes")
    scene = make_scene(args.scene, seed=args.seed, settings=args.settings)
    record_scene(scene, args.out, args.format, overwrite=args.overwrite)
    print(
        f"{args.out}: {scene.frame_count} frames of {scene.width}x{scene.height} px "
        f"at {scene.frame_rate:g} frames/s, all with truth"
    )
    return 0


def record_scene(scene: Scene, out: Path, form: str = "raw", *, overwrite: bool = False) -> None:
    """Render `scene` into the rosbag2 folder `out`, with truth; shows progress.

    Raises
    ------
    InputError
        If the folder is not empty, or cannot be written.
    """
    with RecordingWriter(out, overwrite=overwrite) as writer, counting("rendered") as progress:
        for number, rendered in enumerate(scene.frames(), start=1):
            _write_image(writer, rendered.truth.stamp_ns, rendered.frame, form)
            writer.write_truth(rendered.truth)
            progress(number, scene.frame_count)


def _listing() -> Iterator[str]:
    for name, kind in SCENES.items():
        yield f"{name}: {kind.summary}"
        for spec in specs(kind.parameters).values():
            facts = ", ".join(filter(None, (spec.unit, spec.bounds, " | ".join(spec.choices))))
            yield f"  {spec.name}={spec.default} [{facts}]: {spec.doc}"


def _write_image(writer: RecordingWriter, stamp_ns: int, frame: Frame, form: str) -> None:
    if form == "raw":
        writer.write_image(stamp_ns, frame)
        return
    writer.write_compressed(stamp_ns, "jpeg", jpeg(frame))
