# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`traffic`: follow every vehicle of a source offline, and count them."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path
from typing import Any

from vehicle_pf_tracker.cli.console import UsageError, counting, shown_progress, tell_notices
from vehicle_pf_tracker.cli.many_sources import follow_each
from vehicle_pf_tracker.cli.network_advice import (
    advice_over_sources,
    joined_vehicles,
    network_advice,
)
from vehicle_pf_tracker.cli.option_values import positive_number
from vehicle_pf_tracker.cli.requests import option
from vehicle_pf_tracker.cli.serving import ServeAddress, served
from vehicle_pf_tracker.cli.source_lists import SeveralSources
from vehicle_pf_tracker.cli.source_part import cut_short, numbered_part
from vehicle_pf_tracker.cli.stopping import StillAtWork, Stop, stopping
from vehicle_pf_tracker.cli.target_options import by_name
from vehicle_pf_tracker.core.addresses import short_name
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.outputs import Products, claimed
from vehicle_pf_tracker.counting.zone_occupancy import USUAL_INTERVAL_S
from vehicle_pf_tracker.detection.parameters import (
    MODEL_DETECTOR,
    MOTION_DETECTOR,
    NO_DETECTOR,
    TOPIC_DETECTOR,
)
from vehicle_pf_tracker.following.counted_vehicles import session_and_counter
from vehicle_pf_tracker.following.detection_file import DetectionFile
from vehicle_pf_tracker.following.networks.known_networks import KNOWN_NETWORKS
from vehicle_pf_tracker.following.networks.model_files import model_file
from vehicle_pf_tracker.following.paced_detector import call
from vehicle_pf_tracker.following.traffic_following import TrafficRun
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.parameters.table import to_mapping
from vehicle_pf_tracker.recordings.source import ImageSource
from vehicle_pf_tracker.results.output_files import make_folder, write_json
from vehicle_pf_tracker.results.run_folder import RUN_FILE, describe_run
from vehicle_pf_tracker.results.traffic_results import (
    COUNTS_FILE,
    MOT_TRACKS,
    TRACKS_FILE,
    ZONES,
    track_files,
)
from vehicle_pf_tracker.showing.pictures import Pictures
from vehicle_pf_tracker.showing.traffic_pictures import HEAT_FILE, PATHS_FILE, TrafficPictures
from vehicle_pf_tracker.trackers.registry import TRAFFIC_VARIANT

PRODUCTS = (TRACKS_FILE, MOT_TRACKS, COUNTS_FILE, ZONES, RUN_FILE, PATHS_FILE, HEAT_FILE)
"""Files of a run, which `--overwrite` replaces: no others in the folder are touched."""


@dataclass(frozen=True, kw_only=True)
class Request(SeveralSources):
    """Request of `traffic`."""

    output: Path | None = option(
        "-o", metavar="DIR",
        help="folder for tracks.csv, tracks.txt, counts.csv, zones.csv, run.json, summary.png and "
        "heat.png "
        "(default: results/ and the source's name with _traffic)",
    )  # fmt: skip
    detections: Path | None = option(
        help="detections as MOTChallenge has them, det.txt, instead of a detector",
    )  # fmt: skip
    detector: str | None = option(
        choices=(MOTION_DETECTOR, MODEL_DETECTOR, NO_DETECTOR),
        help="find what moves before a standing camera (the default), use a network of yours, or "
        "follow only the vehicles given with --target",
    )  # fmt: skip
    model: str | None = option(
        metavar="FILE",
        help="a network, YOLOX, YOLOv8 or SSD: an .onnx file, its URL, or one of the names "
        f"{', '.join(KNOWN_NETWORKS)}, which are fetched once from their makers",
    )
    classes: str | None = option(
        metavar="NAMES",
        help="classes of the network that are followed, as car,truck (detector.classes)",
    )
    conf: float | None = option(
        type=float, metavar="SCORE",
        help="least score of a detection of the network (detector.min_score)",
    )  # fmt: skip
    lines: Path | None = option(help="lines, zones and regions of interest, lines.yaml")
    interval: float = option(
        type=positive_number, default=USUAL_INTERVAL_S, metavar="S",
        help="length of the intervals of zones.csv in seconds "
        f"(default: {USUAL_INTERVAL_S:g})",
    )  # fmt: skip


def run(request: Request) -> int:
    """Follow all vehicles of the source, or of each of several, and print a summary."""
    if not request.is_of_several:
        return run_one(request)
    return follow_each(request, TRAFFIC_VARIANT, run_one, _configuration, advice_over_sources)


def run_one(request: Request) -> int:
    """Follow all vehicles of one source, write the results, and print a summary."""
    configuration = _configuration(request)
    stop = Stop()
    source = request.open_source()
    folder = request.output or Path("results", f"{short_name(request.source) or 'run'}_traffic")
    pictures = TrafficPictures(Pictures(request.video))
    outputs = (Products(folder, PRODUCTS), request.video)
    inputs = (*request.inputs, request.detections, request.model, request.lines)
    with claimed(outputs, inputs, overwrite=request.overwrite):
        tracking = _tracking(request, configuration, stop)
        ended = _follow(request, tracking, source, make_folder(folder), stop, pictures)
        has_paths = pictures.write(folder, tracking.counter)
        notices = [*source.notices, *tracking.notices, *pictures.side.notices, *ended]
        tell_notices(notices)
        document = _document(request, configuration, tracking, source.image_topic, notices)
        write_json(folder / RUN_FILE, document)
    sentences = tracking.sentences(document["detector"])
    if document["detector"] == MOTION_DETECTOR:
        found = tracking.session.detected
        sentences += [*joined_vehicles(found), *network_advice(request.command, folder, found)]
    for sentence in sentences:
        print(sentence)
    # Without vehicles the picture has the scene, and no path.
    has_paths = has_paths and bool(tracking.summary.vehicles)
    print(f"results are in {folder}{f'; {PATHS_FILE} shows all paths' if has_paths else ''}")
    if pictures.of_frames.has_video:
        print(f"the video is {request.video}")
    return stop.ended(stop.status if ended else int(bool(pictures.side.notices)))


def _tracking(request: Request, configuration: Configuration, stop: Stop) -> TrafficRun:
    """Make the run, and check all that the options name before the first frame is read."""
    parameters = configuration.tracker
    if parameters.detector.kind == NO_DETECTOR and not (
        request.detections or request.given_targets()
    ):
        raise UsageError(
            "without a detector nothing is followed; give vehicles with --target x,y,w,h, or "
            "--detections FILE"
        )
    detections = DetectionFile(request.detections) if request.detections else None
    # A network that does not end after a signal is left, with what was tracked.
    run_it = stop.leaving if parameters.detector.kind == MODEL_DETECTOR else call
    with shown_progress() as show:
        both = session_and_counter(configuration, run_it, show)
    return TrafficRun(*both, detections, request.interval)


def _follow(
    request: Request,
    tracking: TrafficRun,
    source: ImageSource,
    folder: Path,
    stop: Stop,
    pictures: TrafficPictures,
) -> list[str]:
    """Follow all vehicles to the end or to a signal; return what cut it short."""
    plan = tracking.counter.plan
    port = tracking.session.tracker.parameters.page_port
    address = request.serve or (ServeAddress(port) if port >= 0 else None)
    with (
        stopping(stop),
        counting("tracked") as progress,
        served(address, request.token, pictures.side) as page,
        track_files(folder, counting=plan.is_counting, zones=bool(plan.zones)) as files,
    ):
        first, frames = numbered_part(source, request.start, request.end, stop, progress)
        targets = by_name(request.given_targets(), first[0])
        with suppress(StillAtWork):
            tracking.follow_all(frames, files, pictures, page, targets)
        files.write_zones(tracking.summary.zones.rest())
    return cut_short(stop, source, tracking.summary.frames)


def _document(
    request: Request,
    configuration: Configuration,
    tracking: TrafficRun,
    topic: str,
    notices: Sequence[str],
) -> dict[str, Any]:
    """Return the content of `run.json`; `topic` is that of the images."""
    kind = configuration.tracker.detector.kind
    facts = {
        "variant": TRAFFIC_VARIANT.name,
        "seed": tracking.session.tracker.seed,
        "parameters": {**to_mapping(configuration.tracker), **to_mapping(configuration.session)},
        "detector": str(request.detections or kind),
        "images_with_detections": tracking.session.detected.images,
        "images_with_ambiguous_blobs": tracking.session.detected.ambiguous,
        "images_with_known_sizes": tracking.session.detected.sized,
        "mean_vehicles_without_number": tracking.session.detected.mean_unresolved,
        "summary": tracking.summary.to_json(),
    }
    document = describe_run(request.command, request.source, topic, notices, **facts)
    if kind == MODEL_DETECTOR:
        document["versions"]["onnxruntime"] = metadata.version("onnxruntime")
        document["model_sha256"] = model_file(configuration.tracker.detector.model)[1]
    return document


def _configuration(request: Request) -> Configuration:
    """Return the parameters; the options of the detector go before files and ``--set``."""
    configuration = request.configuration(TRAFFIC_VARIANT)
    if configuration.session.target.box is not None:
        raise InputError("target.x to target.height are for one vehicle; give --target x,y,w,h")
    if request.detections and (request.detector or request.model):
        raise UsageError("give either --detections, or --detector and --model")
    if request.model and request.detector not in {None, MODEL_DETECTOR}:
        raise UsageError(f"--model is not used by --detector {request.detector}; leave one out")
    kind = (
        NO_DETECTOR if request.detections else MODEL_DETECTOR if request.model else request.detector
    )
    given = {
        "lines": str(request.lines) if request.lines else None,
        "detector.kind": kind,
        "detector.model": request.model,
        "detector.classes": request.classes,
        "detector.min_score": request.conf,
    }
    changes = {name: value for name, value in given.items() if value is not None}
    configuration = configuration.updated(changes)
    has_network = configuration.tracker.detector.kind == MODEL_DETECTOR
    if not has_network and not (request.classes is None and request.conf is None):
        raise UsageError("--classes and --conf are for a network; give it with --model")
    if configuration.tracker.detector.kind == TOPIC_DETECTOR:
        raise InputError("detector.kind topic is for nodes; offline, give --detections FILE")
    return configuration
