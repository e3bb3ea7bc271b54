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

"""Commands that a signal ends in the middle leave nothing, and end by that signal."""

import os
import signal
import subprocess
import sys
import time

import pytest
from unmeasured import unmeasured_environment

from vehicle_pf_tracker.cli.main import main
from vehicle_pf_tracker.cli.stopping import Terminated, raising_terminated

# Those who start us in the background may have had signals ignored, which a child inherits.
CODE = (
    "import signal, sys; signal.signal(signal.SIGINT, signal.default_int_handler)\n"
    "signal.signal(signal.SIGHUP, signal.SIG_DFL)\n"
    "from vehicle_pf_tracker.cli.main import main; sys.exit(main())"
)
ENDINGS = {signal.SIGINT: 130, signal.SIGTERM: -signal.SIGTERM, signal.SIGHUP: -signal.SIGHUP}


@pytest.fixture(scope="module")
def clip(tmp_path_factory):
    path = tmp_path_factory.mktemp("clip") / "clip.mp4"
    assert main(["synth", "bar", str(path)]) == 0
    return path


def has_begun(folder):
    """Return whether a recording has its first chunk, a folder an image, or a video its file."""
    recordings = [path.stat().st_size for path in folder.glob(".*.partial/*.mcap")]
    images = folder.glob(".*.partial/img1/*.jpg")
    return any(recordings) or any(images) or any(folder.glob(".*.mp4"))


def end_in_the_middle(folder, number, *words):
    """Run a command, send it a signal when its hidden file has some data; return what is left."""
    process = subprocess.Popen(
        [sys.executable, "-c", CODE, *words], stderr=subprocess.PIPE, text=True, cwd=folder,
        env=unmeasured_environment(),
    )  # fmt: skip
    try:
        deadline = time.monotonic() + 60
        while not has_begun(folder):
            assert process.poll() is None, process.communicate()
            assert time.monotonic() < deadline
            time.sleep(0.002)
        process.send_signal(number)
        _, told = process.communicate(timeout=60)
    finally:
        process.kill()
    assert "Traceback" not in told
    assert process.returncode == ENDINGS[number]
    return sorted(path.name for path in folder.iterdir())


@pytest.mark.parametrize("number", ENDINGS)
def test_a_scene_that_is_not_done_leaves_nothing(tmp_path, number):
    assert end_in_the_middle(tmp_path, number, "synth", "highway", "rec") == []


def test_a_folder_of_many_vehicles_that_is_not_done_leaves_nothing(tmp_path):
    assert end_in_the_middle(tmp_path, signal.SIGTERM, "synth", "traffic-pair", "mot") == []


def test_a_video_that_is_not_done_leaves_nothing(tmp_path):
    assert end_in_the_middle(tmp_path, signal.SIGTERM, "synth", "highway", "a.mp4") == []


def test_an_import_that_is_not_done_leaves_nothing(tmp_path, clip):
    assert end_in_the_middle(tmp_path, signal.SIGTERM, "import", str(clip), "rec") == []


def test_who_ignores_a_signal_goes_on_doing_so():
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with raising_terminated():
            os.kill(os.getpid(), signal.SIGHUP)
    finally:
        signal.signal(signal.SIGHUP, before)


def test_a_second_signal_would_end_the_process_at_once():
    before = signal.signal(signal.SIGTERM, signal.SIG_DFL)
    try:
        with pytest.raises(Terminated), raising_terminated():
            try:
                os.kill(os.getpid(), signal.SIGTERM)
            finally:
                assert signal.getsignal(signal.SIGTERM) is signal.SIG_DFL
    finally:
        signal.signal(signal.SIGTERM, before)
