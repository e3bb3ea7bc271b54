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

"""`road calibrate`: pixels and metres that belong together become the parameters of the road."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from vehicle_pf_tracker.cli.console import UsageError
from vehicle_pf_tracker.cli.picking import POINTS, ask
from vehicle_pf_tracker.cli.progress import counting
from vehicle_pf_tracker.cli.road_pairs import FORM, read_pairs
from vehicle_pf_tracker.cli.shared_options import add_overwrite, positive
from vehicle_pf_tracker.core.outputs import claimed
from vehicle_pf_tracker.evaluation.output_files import write_picture, write_text
from vehicle_pf_tracker.evaluation.road_grid import draw_pixel_grid, draw_road_grid
from vehicle_pf_tracker.parameters.configuration import SessionParameters
from vehicle_pf_tracker.parameters.files import to_yaml
from vehicle_pf_tracker.parameters.road import RoadParameters
from vehicle_pf_tracker.parameters.table import from_mapping, specs, to_mapping
from vehicle_pf_tracker.recordings.source import Source, frame_at, open_source
from vehicle_pf_tracker.road.calibration import format_pairs, parse_pairs
from vehicle_pf_tracker.road.lens import MODELS
from vehicle_pf_tracker.road.plane import Pair, RoadPlane, residuals

_TITLE = "Road. Written by `vehicle-pf-tracker road calibrate`."


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of this verb."""
    add = parser.add_argument
    add("action", choices=("calibrate",), help="fit the mapping from pixels to metres")
    add(
        "source", metavar="SOURCE",
        help="recording, video, folder of images, camera or stream that shows the road",
    )  # fmt: skip
    add("--topic", help="the image topic, if a recording has several")
    add("--frame", type=positive, default=1, metavar="N", help="image to use (default: 1)")
    add(
        "--pair", action="append", default=[], metavar="U,V=X,Y", dest="pairs",
        help="a pixel and the point of the road that it shows, px and m; repeatable; without pairs "
        "a page is served on which to click them",
    )  # fmt: skip
    add("--pairs", type=Path, metavar="FILE", dest="file", help=f"YAML file with {FORM}")
    add("--intrinsics", default="", metavar="FX,FY,CX,CY", help="as in CameraInfo")
    add("--distortion-model", default="none", choices=MODELS)
    add("--distortion", default="", metavar="K1,K2,…", help="as in CameraInfo")
    add("--frame-id", default="road", help="frame of the road (default: road)")
    add(
        "--grid", type=Path, metavar="PNG",
        help="picture with the road's lines; without pairs and -o, with pixel coordinates to read "
        "points off instead of a page",
    )  # fmt: skip
    add("-o", "--output", type=Path, metavar="YAML", help="parameter file for nodes and `run`")
    add_overwrite(parser)


def run(args: argparse.Namespace) -> int:
    """Fit, print the residuals, and write parameters and picture."""
    pairs = (*parse_pairs(";".join(args.pairs)), *(read_pairs(args.file) if args.file else ()))
    source = open_source(args.source, topic=args.topic)
    inputs = (args.source, args.file)
    with claimed((args.grid, args.output), inputs, overwrite=args.overwrite):
        return _calibrate(args, source, pairs)


def _calibrate(args: argparse.Namespace, source: Source, pairs: tuple[Pair, ...]) -> int:
    with counting("read") as progress:
        frame = frame_at(source, args.frame, progress)
    if not pairs and args.grid is not None and args.output is None:
        write_picture(args.grid, draw_pixel_grid(frame))
        print(f"{args.grid}: read off pixels of points whose place on the road you know")
        return 0
    pairs = pairs or tuple(ask(source, POINTS, args.frame))
    if not pairs:
        raise UsageError("nothing was picked")
    road = _road(args, pairs)
    plane = road.plane(road.lens, None)
    print(_table(plane, pairs), end="")
    if args.grid is not None:
        write_picture(args.grid, draw_road_grid(frame, plane, pairs))
    if args.output is not None:
        _write_parameters(args.output, road)
        print(f"{args.output}: use it with --params, or as params_file of a node")
    return 0


def _road(args: argparse.Namespace, pairs: tuple[Pair, ...]) -> RoadParameters:
    values = {
        "road.pairs": format_pairs(pairs),
        "road.intrinsics": args.intrinsics,
        "road.distortion_model": args.distortion_model,
        "road.distortion": args.distortion,
        "road.frame_id": args.frame_id,
    }
    return from_mapping(SessionParameters, values).road


def _table(plane: RoadPlane, pairs: Sequence[Pair]) -> str:
    """Write the residual of every pair, and how long a pixel is on the road."""
    in_image, on_road = residuals(plane, pairs)
    lines = [f"{'pixel':>18}  {'road, m':>18}  {'off, px':>8}  {'off, m':>8}"]
    for pair, px, metres in zip(pairs, in_image, on_road, strict=True):
        pixel, road = (f"{one[0]:.1f},{one[1]:.1f}" for one in (pair.pixel, pair.road))
        lines.append(f"{pixel:>18}  {road:>18}  {px:8.2f}  {metres:8.3f}")
    rms = [float(np.sqrt(np.mean(one**2))) for one in (in_image, on_road)]
    lines.append(f"{'root mean square':>38}  {rms[0]:8.2f}  {rms[1]:8.3f}")
    if len(pairs) == 4:
        lines.append("four pairs always fit exactly: give more to see how well they were read")
    lengths = [np.linalg.norm(plane.jacobian(np.array(pair.pixel)), 2) for pair in pairs]
    lines.append(f"a pixel is {min(lengths):.2g} to {max(lengths):.2g} m of road there")
    return "\n".join([*lines, ""])


def _write_parameters(path: Path, road: RoadParameters) -> None:
    session = SessionParameters(road=road)
    table = {name: spec for name, spec in specs(SessionParameters).items() if "road." in name}
    write_text(path, to_yaml(table, to_mapping(session), _TITLE))
