# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`road calibrate`: pixels and metres that belong together become the parameters of the road."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from vehicle_pf_tracker.cli.console import counting, tell_notices
from vehicle_pf_tracker.cli.option_values import positive
from vehicle_pf_tracker.cli.pick_page import ask
from vehicle_pf_tracker.cli.picked_shapes import PAIR_FORM, PAIRS_SECTION, pair_of
from vehicle_pf_tracker.cli.requests import VerbRequest, option, positional
from vehicle_pf_tracker.cli.shared_options import OverwriteOption, SourceOptions
from vehicle_pf_tracker.cli.target_options import read_list
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.outputs import claimed
from vehicle_pf_tracker.parameters.configuration import SessionParameters
from vehicle_pf_tracker.parameters.files import to_yaml
from vehicle_pf_tracker.parameters.road import format_pairs, parse_pairs
from vehicle_pf_tracker.parameters.table import from_mapping, specs, to_mapping
from vehicle_pf_tracker.recordings.source import ImageSource, frame_at
from vehicle_pf_tracker.results.output_files import write_picture, write_text
from vehicle_pf_tracker.road.homography import LEAST_PAIRS
from vehicle_pf_tracker.road.lens import LENS_MODELS
from vehicle_pf_tracker.road.plane import Pair, RoadPlane, residuals
from vehicle_pf_tracker.road.suspects import disagreement
from vehicle_pf_tracker.showing.grids import draw_road_grid

_TITLE = "Road. Written by `vehicle-pf-tracker road calibrate`."
"""First line of the file."""


@dataclass(frozen=True, kw_only=True)
class _Action(VerbRequest):
    """Request with a word before its source."""

    action: str = positional(choices=("calibrate",), help="fit the mapping from pixels to metres")


@dataclass(frozen=True, kw_only=True)
class Request(SourceOptions, OverwriteOption, _Action):
    """Request of `road calibrate`."""

    frame: int = option(type=positive, default=1, metavar="N", help="frame to use (default: 1)")
    pairs: Sequence[str] = option(
        "--pair", action="append", default=[], metavar="U,V=X,Y",
        help="a pixel and the point of the road that it shows, px and m; repeatable; without pairs "
        "a page is served on which to click them",
    )  # fmt: skip
    file: Path | None = option("--pairs", help=f"YAML file with pairs: [{PAIR_FORM}]")
    intrinsics: str = option(
        default="", metavar="FX,FY,CX,CY",
        help="focal lengths and principal point of the camera, px, as in CameraInfo",
    )  # fmt: skip
    distortion_model: str = option(
        default="none",
        choices=LENS_MODELS,
        help="how the lens bends straight lines (default: none)",
    )
    distortion: str = option(default="", metavar="K1,K2,…", help="numbers of that model")
    frame_id: str = option(
        default="road", metavar="NAME", help="the road's frame in ROS (default: road)"
    )
    grid: Path | None = option(
        metavar="PNG",
        help="picture with the road's lines; `pick --grid` writes one with pixel coordinates",
    )  # fmt: skip
    output: Path | None = option("-o", metavar="YAML", help="parameter file for nodes and `run`")


def run(request: Request) -> int:
    """Fit, print the residuals, and write parameters and picture."""
    pairs = parse_pairs(";".join(request.pairs))
    if request.file:
        pairs += tuple(read_list(request.file, PAIRS_SECTION, PAIR_FORM, pair_of))
    source = request.open_source()
    inputs = (request.source, request.file)
    with claimed((request.grid, request.output), inputs, overwrite=request.overwrite):
        return _calibrate(request, source, pairs)


def _calibrate(request: Request, source: ImageSource, pairs: tuple[Pair, ...]) -> int:
    """Fit the road to pairs, or to those that the user clicks, and write what is asked for."""
    with counting("read") as progress:
        frame = frame_at(source, request.frame, progress)
    if not pairs:
        drawn = ask(source, [PAIRS_SECTION], request.frame)
        pairs = tuple(map(pair_of, drawn[PAIRS_SECTION]))
    session = _session(request, pairs)
    road = session.road
    plane = road.plane(road.lens, None)
    print(_table(plane, pairs), end="")
    if doubt := disagreement(pairs, road.lens):
        tell_notices([doubt])
    if request.grid is not None:
        write_picture(request.grid, draw_road_grid(frame, plane, pairs))
    if request.output is not None:
        table = {name: spec for name, spec in specs(SessionParameters).items() if "road." in name}
        write_text(request.output, to_yaml(table, to_mapping(session), _TITLE))
        print(f"{request.output}: use it with --params, or as params_file of a node")
    return 0


def _session(request: Request, pairs: tuple[Pair, ...]) -> SessionParameters:
    """Make the parameters; where the pairs determine no road, the error says which to read again.

    Raises
    ------
    InputError
        If an option is invalid, or the pairs determine no road.
    """
    names = ("intrinsics", "distortion_model", "distortion", "frame_id")
    values = {f"road.{name}": getattr(request, name) for name in names}
    lens = from_mapping(SessionParameters, values).road.lens
    try:
        return from_mapping(SessionParameters, {"road.pairs": format_pairs(pairs), **values})
    except InputError as error:
        doubt = disagreement(pairs, lens) if len(pairs) >= LEAST_PAIRS else ""
        raise InputError(f"{error}; {doubt}" if doubt else str(error)) from None


def _table(plane: RoadPlane, pairs: Sequence[Pair]) -> str:
    """Write the residual of every pair, and how long a pixel is on the road."""
    in_image, on_road = residuals(plane, pairs)
    lines = [f"{'pixel':>18}  {'road, m':>18}  {'off, px':>8}  {'off, m':>8}"]
    for pair, px, metres in zip(pairs, in_image, on_road, strict=True):
        pixel, road = (f"{point[0]:.1f},{point[1]:.1f}" for point in (pair.pixel, pair.road))
        lines.append(f"{pixel:>18}  {road:>18}  {px:8.2f}  {metres:8.3f}")
    rms = [float(np.sqrt(np.mean(errors**2))) for errors in (in_image, on_road)]
    lines.append(f"{'root mean square':>38}  {rms[0]:8.2f}  {rms[1]:8.3f}")
    if len(pairs) == 4:
        lines.append("four pairs always fit exactly: give more to see how well they were read")
    lengths = [plane.pixel_length(plane.ideal(np.array(pair.pixel))) for pair in pairs]
    lines.append(f"a pixel is {min(lengths):.2g} to {max(lengths):.2g} m of road there")
    return "\n".join([*lines, ""])
