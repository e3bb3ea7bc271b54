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

"""`traffic`: follow every vehicle of a source offline, and count them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime, timezone
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle_pf_tracker.cli import parameter_options
from vehicle_pf_tracker.cli.console import UsageError, counting, tell_notices
from vehicle_pf_tracker.cli.requests import option, switch
from vehicle_pf_tracker.cli.stopping import (
    TrackingRequest,
    cut_short,
    numbered_frames,
    peeked,
    stopping,
)
from vehicle_pf_tracker.cli.targets import (
    PictureWindow,
    TargetOption,
    by_name,
    parse_target,
    read_targets,
)
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.outputs import Products, claimed
from vehicle_pf_tracker.offline.detectors import detector_maker
from vehicle_pf_tracker.offline.following import Pictures
from vehicle_pf_tracker.offline.output_files import make_folder, write_json
from vehicle_pf_tracker.offline.run_folder import RUN, versions
from vehicle_pf_tracker.offline.traffic_files import (
    COUNTS,
    MOT_TRACKS,
    TRACKS,
    DetectionFile,
    track_files,
)
from vehicle_pf_tracker.offline.traffic_following import Target, TrafficRun
from vehicle_pf_tracker.offline.traffic_summary import limited
from vehicle_pf_tracker.offline.video_writer import NO_ENCODER, has_encoder
from vehicle_pf_tracker.parameters.counting_plan import CountingPlan, read_counting_plan
from vehicle_pf_tracker.parameters.road import RoadParameters
from vehicle_pf_tracker.parameters.table import to_mapping
from vehicle_pf_tracker.recordings.source import Source, open_source
from vehicle_pf_tracker.road.plane import RoadPlane
from vehicle_pf_tracker.trackers.registry import TRAFFIC
from vehicle_pf_tracker.trackers.traffic.association import check_library
from vehicle_pf_tracker.trackers.traffic.counting import Counter
from vehicle_pf_tracker.trackers.traffic.parameters import MODEL, MOTION, NONE, TOPIC
from vehicle_pf_tracker.trackers.traffic.session import Detector, TrafficSession
from vehicle_pf_tracker.trackers.traffic.tracker import TrafficTracker

if TYPE_CHECKING:
    from vehicle_pf_tracker.parameters.configuration import Configuration

PICTURE = "summary.png"
PRODUCTS = (TRACKS, MOT_TRACKS, COUNTS, RUN, PICTURE)


@dataclass(frozen=True, kw_only=True)
class Request(TrackingRequest):
    """Request of `traffic`."""

    output: Path | None = option(
        "-o", type=Path, metavar="DIR",
        help="folder for tracks.csv, tracks.txt, counts.csv, run.json and summary.png "
        "(default: results/ and the source's name with _traffic)",
    )  # fmt: skip
    detections: Path | None = option(
        type=Path, metavar="FILE",
        help="detections as MOTChallenge has them, det.txt, instead of a detector",
    )  # fmt: skip
    detector: str | None = option(
        choices=(MOTION, MODEL, NONE),
        help="find what moves before a standing camera (the default), use a network of yours, or "
        "follow only the vehicles given with --target",
    )  # fmt: skip
    model: str | None = option(metavar="FILE", help="the network, .onnx: YOLOX, YOLOv8 or SSD")
    lines: Path | None = option(
        type=Path, metavar="FILE", help="lines and zones to count at, lines.yaml"
    )
    video: Path | None = option(
        type=Path, metavar="FILE",
        help="write the frames with all vehicles and counts to FILE, an mp4",
    )  # fmt: skip
    visible_only: bool = switch(
        help="leave vehicles that are occluded, and so predicted, out of tracks.txt"
    )
    target: Sequence[TargetOption] = option(
        type=parse_target, action="append", default=[],
        metavar="[NAME][@FRAME:]X,Y,W,H",
        help="a vehicle to follow from the first frame or from FRAME on, beside those that are "
        "detected: top-left corner and size in px; repeatable",
    )  # fmt: skip


def run(request: Request) -> int:
    """Follow all vehicles, write the results, and print a summary."""
    check_library()
    setup = _Setup.of(request)
    source = open_source(request.source, topic=request.topic, fps=request.fps)
    folder = request.output or Path("results", f"{Path(request.source).stem or 'run'}_traffic")
    outputs = (Products(folder, PRODUCTS), request.video)
    inputs = (*request.inputs, request.detections, request.model, request.lines)
    with claimed(outputs, inputs, overwrite=request.overwrite):
        return _follow(request, setup, source, make_folder(folder))


def _follow(request: Request, setup: _Setup, source: Source, folder: Path) -> int:
    window = PictureWindow(request.source) if request.show else None
    pictures = Pictures(request.video, show=window.show if window else None)
    with (
        stopping() as stop,
        counting("tracked") as progress,
        track_files(folder, counting=bool(setup.plan), visible_only=request.visible_only) as files,
    ):
        first, frames = peeked(numbered_frames(source, request, stop, progress))
        tracking = setup.tracking(first[0])
        tracking.follow(frames, files, pictures)
    notices = [*source.notices, *setup.notices(), *tracking.notices]
    if request.video and not has_encoder():
        notices.append(NO_ENCODER)
    ended = cut_short(stop, source, tracking.summary.frames)
    notices += ended
    tell_notices(limited(notices))
    write_json(folder / RUN, _description(request, source, setup, tracking, notices))
    if not tracking.paths.write(folder / PICTURE, tracking.counter):
        (folder / PICTURE).unlink(missing_ok=True)
    for sentence in tracking.summary.sentences(tracking.counter):
        print(sentence)
    print(f"results are in {folder}; {PICTURE} shows all paths")
    if request.video:
        print(f"the video is {request.video}")
    return stop.status if ended else 0


@dataclass(frozen=True, slots=True)
class _Setup:
    """Everything that the options choose, checked before the first frame is read."""

    configuration: Configuration
    plan: CountingPlan | None
    plane: RoadPlane | None
    detections: DetectionFile | None
    make_detector: Callable[[], Detector] | None
    targets: Sequence[TargetOption]

    @classmethod
    def of(cls, request: Request) -> _Setup:
        configuration = _configuration(request)
        targets = [*request.target, *(read_targets(request.targets) if request.targets else [])]
        if configuration.tracker.detector.kind == NONE and not (request.detections or targets):
            raise UsageError(
                "without a detector nothing is followed; give vehicles with --target x,y,w,h, or "
                "--detections FILE"
            )
        return cls(
            configuration,
            read_counting_plan(lines)
            if (lines := request.lines or _lines(configuration))
            else None,
            _plane(configuration.session.road),
            DetectionFile(request.detections) if request.detections else None,
            detector_maker(configuration.tracker.detector),
            targets,
        )

    def tracking(self, first: int) -> TrafficRun:
        """Make the run; its first frame has the number `first`."""
        parameters, settings = self.configuration.tracker, self.configuration.session
        session = TrafficSession(
            TrafficTracker(parameters, self.plane),
            self.make_detector,
            frame_rate=parameters.frame_rate,
            reset_on_time_jump=settings.reset_on_time_jump,
        )
        return TrafficRun(
            session,
            Counter(self.plan, self.plane) if self.plan else None,
            detections_of=self.detections.of if self.detections is not None else None,
            targets=self._targets_by_frame(first),
        )

    def notices(self) -> list[str]:
        """Return irregularities of the files, a sentence each."""
        return self.detections.notices if self.detections is not None else []

    def _targets_by_frame(self, first: int) -> Mapping[int, Sequence[Target]]:
        found: dict[int, list[Target]] = {}
        for name, boxes in by_name(self.targets, first).items():
            for frame, box in boxes.items():
                found.setdefault(frame, []).append(Target(name, box))
        return found


def _configuration(request: Request) -> Configuration:
    """Return the parameters; the options of the detector go before files and ``--set``."""
    configuration = parameter_options.chosen(TRAFFIC, request)
    if configuration.session.target.box is not None:
        raise InputError("target.x to target.height are for one vehicle; give --target x,y,w,h")
    if request.detections and (request.detector or request.model):
        raise UsageError("give either --detections, or --detector and --model")
    if request.model and request.detector not in {None, MODEL}:
        raise UsageError(f"--model is not used by --detector {request.detector}; leave one out")
    if request.detections:
        return configuration.updated({"detector.kind": NONE})
    if request.model:
        return configuration.updated({"detector.kind": MODEL, "detector.model": request.model})
    if request.detector:
        return configuration.updated({"detector.kind": request.detector})
    if configuration.tracker.detector.kind == TOPIC:
        raise InputError("detector.kind topic is for nodes; offline, give --detections FILE")
    return configuration


def _lines(configuration: Configuration) -> Path | None:
    return Path(configuration.tracker.lines) if configuration.tracker.lines else None


def _plane(road: RoadParameters) -> RoadPlane | None:
    """Return the calibrated road; its lens and pose cannot come from topics."""
    if not road.is_set:
        return None
    if road.from_camera_info or road.from_tf:
        raise InputError(
            "road.from_camera_info and road.from_tf are for nodes; offline, give road.intrinsics, "
            "road.distortion and road.camera_pose"
        )
    return road.plane(road.lens, road.pose)


def _description(
    request: Request,
    source: Source,
    setup: _Setup,
    tracking: TrafficRun,
    notices: Sequence[str],
) -> dict[str, Any]:
    """Make the content of `run.json`."""
    configuration = setup.configuration
    return {
        "command": list(request.command),
        "made": datetime.now(timezone.utc).isoformat(timespec="seconds"),
        "recording": request.source,
        "image_topic": source.image_topic,
        "variant": TRAFFIC.name,
        "seed": tracking.session.tracker.seed,
        "detector": str(request.detections or configuration.tracker.detector.kind),
        "parameters": {
            **to_mapping(configuration.tracker),
            **to_mapping(configuration.session),
        },
        "versions": {**versions(), **_runtime_version(configuration.tracker.detector.kind)},
        "summary": tracking.summary.to_json(tracking.counter),
        "notices": list(notices),
    }


def _runtime_version(kind: str) -> dict[str, str]:
    return {"onnxruntime": metadata.version("onnxruntime")} if kind == MODEL else {}
