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

"""Last step of the demo: every vehicle of its scene, found by motion."""

from __future__ import annotations

from pathlib import Path

from vehicle_pf_tracker.evaluation.output_files import make_folder
from vehicle_pf_tracker.evaluation.traffic.following import TrafficRun
from vehicle_pf_tracker.evaluation.traffic.track_files import track_files
from vehicle_pf_tracker.recordings.reader import Recording
from vehicle_pf_tracker.trackers.traffic.motion_detector import MotionDetector
from vehicle_pf_tracker.trackers.traffic.session import TrafficSession
from vehicle_pf_tracker.trackers.traffic.tracker import TrafficTracker


def follow_all(recording: Recording, folder: Path, picture: Path) -> list[str]:
    """Follow all vehicles with the defaults, as `traffic` does.

    Parameters
    ----------
    recording : Recording
        The demo's scene.
    folder : Path
        Folder for the tracks.
    picture : Path
        Picture to write: all paths with their numbers.

    Returns
    -------
    list of str
        What was found, a line for each fact.
    """
    tracking = TrafficRun(TrafficSession(TrafficTracker(), MotionDetector))
    with track_files(make_folder(folder)) as files:
        tracking.follow(enumerate(recording.frames(), start=1), files)
    tracking.paths.write(picture)
    return tracking.summary.sentences()
