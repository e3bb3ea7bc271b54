# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Commands that a signal ends leave nothing half done, end by that signal, and can go on."""

import csv
import os
import signal
import time
from tempfile import TemporaryFile

import pytest
from small_recordings import record
from unmeasured import unmeasured_environment

from vehicle_pf_tracker.cli.main import main
from vehicle_pf_tracker.cli.stopping import Terminated, raising_terminated

# Those who start us in the background may have had signals ignored, which a child inherits.
CODE = (
    "import signal, sys; signal.signal(signal.SIGINT, signal.default_int_handler)\n"
    "signal.signal(signal.SIGHUP, signal.SIG_DFL)\n"
    "from vehicle_pf_tracker.cli.main import main; sys.exit(main())"
)
ENDINGS = {signal.SIGINT: 130, **{n: -n for n in (signal.SIGTERM, signal.SIGHUP, signal.SIGKILL)}}


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


@pytest.fixture
def signalled(unmeasured_python, tmp_path):
    """Return a function that runs a command in `tmp_path`, and sends it a signal when it has begun.

    What it returns is what the command printed of errors.
    """

    def run(number, has_begun, *words, code=CODE, status=None):
        with TemporaryFile("w+") as output, TemporaryFile("w+") as errors:
            process = unmeasured_python.run(
                code, words, unmeasured_environment(), output, errors, tmp_path
            )
            try:
                deadline = time.monotonic() + 60
                while not has_begun():
                    assert process.poll() is None, errors.seek(0) or errors.read()
                    assert time.monotonic() < deadline
                    time.sleep(0.002)
                process.send_signal(number)
                process.wait(60)
            finally:
                process.kill()
            errors.seek(0)
            told = errors.read()
        assert "Traceback" not in told
        assert process.returncode == (ENDINGS[number] if status is None else status)
        return told

    return run


@pytest.fixture
def end_in_the_middle(signalled, tmp_path):
    """Send a signal when the command's hidden file has some data; return what is left."""

    def run(number, *words):
        signalled(number, lambda: has_begun(tmp_path), *words)
        return sorted(path.name for path in tmp_path.iterdir())

    return run


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_scene_that_is_not_done_leaves_nothing(end_in_the_middle, number):
    assert end_in_the_middle(number, "synth", "highway", "rec") == []


def test_a_video_that_is_not_done_leaves_nothing(end_in_the_middle):
    assert end_in_the_middle(signal.SIGTERM, "synth", "highway", "a.mp4") == []


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_an_import_that_is_not_done_leaves_nothing(end_in_the_middle, clip, number):
    assert end_in_the_middle(number, "import", str(clip), "rec") == []


STUCK = """
import ctypes, itertools
from vehicle_pf_tracker.detection.detections import Detections
class Stuck:
    disturbed = is_blind = False
    calls = itertools.count(1)
    def detect(self, frame, tracks=(), period=0.0):
        call = next(self.calls)
        if call == 41:
            open("stuck", "w").close()
            ctypes.CDLL(None).sleep(10_000)
        return Detections.make([[100, 3.0 * call, 40, 30]], [0.9])
from vehicle_pf_tracker.following import counted_vehicles
counted_vehicles.detector_maker = lambda *_: Stuck
"""


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_network_that_never_returns_is_left_with_what_was_tracked(
    signalled, tmp_path, clip, number
):
    (tmp_path / "net.onnx").touch()
    words = ["traffic", str(clip), "--model", "net.onnx", "-o", "out"]
    has_begun = (tmp_path / "stuck").exists
    told = signalled(number, has_begun, *words, code=STUCK + CODE, status=128 + number)
    assert "a signal ended the run after 40 of " in told
    with (tmp_path / "out" / "tracks.csv").open() as file:
        assert max(int(row["frame"]) for row in csv.DictReader(file)) == 40
    assert (tmp_path / "out" / "run.json").is_file()


STALLED = """
import ctypes, itertools, time
import cv2, numpy
class Stalled:
    counts = itertools.count(1)
    def __init__(self, *_): pass
    def isOpened(self): return True
    def get(self, _): return 0.0
    def release(self): pass
    def read(self):
        count = next(self.counts)
        if count == 41:
            open("stuck", "w").close()
            ctypes.CDLL(None).sleep(10_000)
        time.sleep(0.04)  # a vehicle is one after half a second
        image = numpy.random.default_rng(0).integers(90, 130, (120, 160, 3), numpy.uint8)
        image[40:60, 2 * count : 2 * count + 30] = (30, 60, 210)
        return True, image
cv2.VideoCapture = Stalled
"""


@pytest.mark.parametrize(
    ("words", "table"),
    [(["run", "0", "--target", "2,40,30,20"], "estimates.csv"), (["traffic", "0"], "tracks.csv")],
)
def test_a_camera_that_stalls_is_left_with_what_was_tracked(signalled, tmp_path, words, table):
    stuck = tmp_path / "stuck"
    signalled(signal.SIGINT, stuck.exists, *words, "-o", "out", code=STALLED + CODE, status=0)
    with (tmp_path / "out" / table).open() as file:
        assert max(int(row["frame"]) for row in csv.DictReader(file)) == 40
    assert (tmp_path / "out" / "run.json").is_file()


def test_who_ignores_a_signal_goes_on_doing_so():
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with raising_terminated():
            os.kill(os.getpid(), signal.SIGHUP)
        assert signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
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


def estimates(folder):
    return {
        str(path.relative_to(folder)): [
            {name: text for name, text in row.items() if name != "step_ms"}
            for row in csv.DictReader(path.open())
        ]
        for path in sorted(folder.glob("cells/*/*/seed-*/estimates.csv"))
    }


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_what_was_ended_goes_on_and_comes_out_the_same(signalled, tmp_path, number):
    record(tmp_path / "bag")
    words = ["evaluate", str(tmp_path / "bag"), "--variants", "pf,ms", "--seeds", "60"]
    words += ["--workers", "2", "-o"]
    ended, whole = tmp_path / "ended", tmp_path / "whole"
    told = signalled(number, lambda: len(estimates(ended)) >= 5, *words, str(ended))
    assert ("interrupted; run the same command to resume" in told) == (number == signal.SIGINT)
    before = {
        path: path.stat().st_mtime_ns for path in ended.glob("cells/*/*/seed-*/estimates.csv")
    }
    assert 5 <= len(before) < 61
    assert not (ended / "report.html").exists()
    assert main([*words, str(ended)]) == 0
    assert {path: path.stat().st_mtime_ns for path in before} == before
    assert main([*words, str(whole)]) == 0
    assert len(estimates(whole)) == 61
    assert estimates(ended) == estimates(whole)
