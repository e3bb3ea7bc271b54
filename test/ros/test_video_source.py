# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The executable `video_source`, heard through Fast DDS, with sources that break and come back."""

from __future__ import annotations

import itertools
import json
import math
import re
import signal
import threading
import time
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import cv2
import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from diagnostic_msgs.msg import DiagnosticArray
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import Image
from tracker_rig import TARGET, road

from vehicle_pf_tracker.ros.messages import stamp_ns

pytestmark = pytest.mark.ros

FPS = 25
COUNT = 10


@pytest.fixture
def folder(tmp_path):
    """A folder of images at 25 Hz."""
    made = tmp_path / "frames"
    (made / "img").mkdir(parents=True)
    for number, frame in enumerate(road(COUNT), start=1):
        cv2.imwrite(str(made / "img" / f"{number:06}.png"), cv2.cvtColor(frame, cv2.COLOR_RGB2BGR))
    (made / "sequence.json").write_text(json.dumps({"fps": FPS}))
    return made


@pytest.fixture
def start(start_process):
    """Return a function that runs `video_source SOURCE` with parameters."""

    def start(source, **parameters):
        code = (
            "import signal, sys; signal.signal(signal.SIGINT, signal.default_int_handler);"
            "from vehicle_pf_tracker.ros.executables import main; sys.exit(main('video_source'))"
        )
        given = [word for name, value in parameters.items() for word in ("-p", f"{name}:={value}")]
        return start_process("-c", code, str(source), "--ros-args", *given)

    return start


def test_images_are_those_of_the_source_at_its_times(bench, start, folder):
    start(folder, loop=True, frame_id="mast")
    images = bench.collect(Image, "image", 50)
    bench.wait_for(lambda: len(images) > 2 * COUNT)
    assert {image.header.frame_id for image in images} == {"mast"}
    frames = [frame.tobytes() for frame in road(COUNT)]
    order = [frames.index(bytes(image.data)) for image in images]
    assert all((b - a) % COUNT == 1 for a, b in itertools.pairwise(order))
    stamps = [stamp_ns(image.header) for image in images]
    steps = [b - a for a, b, n in zip(stamps, stamps[1:], order[1:], strict=False) if n]
    assert set(steps) == {10**9 // FPS}
    assert all(a < b for a, b in itertools.pairwise(stamps))
    assert abs(stamps[-1] - time.time_ns()) < 60e9


@pytest.mark.slow
def test_a_tracker_hears_it_without_a_word_of_remapping(bench, start, start_node, folder):
    names = ("x", "y", "width", "height")
    target = [f"target.{name}:={float(v)}" for name, v in zip(names, TARGET, strict=True)]
    start_node("pf", *(word for one in target for word in ("-p", one)))
    modes = bench.collect(DiagnosticArray, "/pf_tracker/mode", 50)
    start(folder, loop=True)
    bench.wait_for(lambda: any(one.status[0].message == "TRACKING" for one in modes), 120.0)


def test_a_folder_ends_with_the_process(start, folder):
    process = start(folder, fps=200)
    assert process.wait() == 0
    assert f"the source has ended after {COUNT} images" in process.output


def slow(*values):
    return pytest.param(*values, marks=pytest.mark.slow)


@pytest.mark.parametrize(
    ("source", "parameters", "said"),
    [
        ("/nowhere.mp4", {}, "there is no file or folder /nowhere.mp4"),
        ("", {}, "give a source"),
        slow("/dev/null", {}, "/dev/null is not a regular file or a folder"),
        slow(__file__, {}, "is not a video file that can be decoded"),
        slow("rec.mcap", {}, "rec.mcap is a recording; `bag_replay rec.mcap` plays it"),
        slow("http://u:hunter2@127.0.0.1:9/stream", {}, "http://***@127.0.0.1:9/stream cannot"),
        slow("FOLDER", {"frame_id": 5}, "frame_id must be"),
        ("FOLDER", {"fps": "quick"}, "fps must be a number, got 'quick'"),
        slow("FOLDER", {"fps": -2}, "fps must be"),
    ],
)
def test_a_mistake_ends_in_one_sentence(start, folder, source, parameters, said):
    process = start(folder if source == "FOLDER" else source, **parameters)
    assert process.wait() == 1
    assert process.output.startswith("video_source: ")
    assert said in process.output
    assert process.output.count("\n") == 1


def test_an_image_that_cannot_be_read_is_left_out_and_said(start, folder):
    (folder / "img" / "000004.png").write_bytes(b"no image")
    process = start(folder)
    assert process.wait() == 0
    assert "000004.png cannot be read" in process.output
    assert "Traceback" not in process.output


@pytest.mark.parametrize(
    "number",
    [
        signal.SIGINT,
        *(pytest.param(s, marks=pytest.mark.slow) for s in (signal.SIGTERM, signal.SIGHUP)),
    ],
)
@pytest.mark.parametrize("loop", [True, False])
def test_a_signal_ends_it_well(bench, start, folder, number, loop):
    process = start(folder, loop=loop, fps=FPS if loop else 0.5)
    images = bench.collect(Image, "image")
    bench.wait_for(lambda: images)
    process.send(number)
    assert process.wait() == 0, process.output
    assert "Traceback" not in process.output
    assert "Failed to publish" not in process.output  # a log line after the end of ROS


@pytest.fixture
def vanished(bench, start, folder):
    """A source whose folder has vanished, and its images until then."""
    process = start(folder, loop=True)
    images = bench.collect(Image, "image")
    bench.wait_for(lambda: images)
    folder.rename(folder.with_name("elsewhere"))
    process.wait_for_output("trying again after 1 s")
    return process, images


def test_a_folder_that_vanishes_and_appears_again(bench, vanished, folder):
    process, images = vanished
    folder.with_name("elsewhere").rename(folder)
    process.wait_for_output("images again after")
    before = len(images)
    bench.wait_for(lambda: len(images) > before + 1)


def test_a_signal_is_obeyed_while_the_source_is_away(vanished):
    process, _ = vanished
    process.send(signal.SIGTERM)
    assert process.wait() == 0


class Stream:
    """A network camera of `port`, which can be broken off: JPEG images over HTTP.

    It falls silent after `most` images.
    """

    def __init__(self, port: int = 0, most: float = math.inf):
        image = cv2.imencode(".jpg", road(1)[0])[1].tobytes()
        lasts = threading.Event()
        lasts.set()

        class Handler(BaseHTTPRequestHandler):
            def do_GET(self):
                self.send_response(200)
                self.send_header("Content-Type", "multipart/x-mixed-replace; boundary=frame")
                self.end_headers()
                head = f"--frame\r\nContent-Type: image/jpeg\r\nContent-Length: {len(image)}"
                sent = 0
                while lasts.is_set():
                    if sent < most:
                        self.wfile.write(head.encode() + b"\r\n\r\n" + image + b"\r\n")
                        sent += 1
                    time.sleep(0.02)

            def log_message(self, *words):
                pass

        self._lasts = lasts
        self._server = ThreadingHTTPServer(("127.0.0.1", port), Handler)
        self._server.daemon_threads = True
        self.port = self._server.server_address[1]
        threading.Thread(target=self._server.serve_forever, daemon=True).start()

    def end(self):
        self._lasts.clear()
        self._server.shutdown()
        self._server.server_close()


needs_streams = pytest.mark.skipif(
    cv2.CAP_FFMPEG not in cv2.videoio_registry.getStreamBackends(),
    reason="this OpenCV reads no network streams",
)


@needs_streams
def test_a_stream_that_breaks_is_opened_again(bench, start):
    stream = Stream()
    process = start(f"http://127.0.0.1:{stream.port}/cam.mjpg")
    images = bench.collect(Image, "image", qos_profile_sensor_data)
    bench.wait_for(lambda: len(images) > 3)
    stamps = [stamp_ns(image.header) for image in images]
    assert all(a < b for a, b in itertools.pairwise(stamps))
    assert abs(stamps[-1] - time.time_ns()) < 60e9
    stream.end()
    process.wait_for_output("sends no more images; trying again after 1 s", 60.0)
    assert process.popen.poll() is None
    again = Stream(stream.port)
    process.wait_for_output("images again after", 60.0)
    before = len(images)
    bench.wait_for(lambda: len(images) > before + 3)
    process.send(signal.SIGINT)
    assert process.wait() == 0
    again.end()


def shared_memory(process) -> list[Path]:
    """Files of Fast DDS that a process has mapped."""
    maps = Path("/proc", str(process.popen.pid), "maps").read_text().splitlines()
    return [Path(line.split()[-1]) for line in maps if re.search("/fast(rtps|dds)_[0-9a-f]", line)]


@needs_streams
@pytest.mark.parametrize("most", [0, pytest.param(200, marks=pytest.mark.slow)])
def test_a_signal_is_obeyed_while_a_stream_is_silent(bench, start, most):
    stream = Stream(most=most)
    process = start(f"http://127.0.0.1:{stream.port}/cam.mjpg")
    own = bench.wait_for(lambda: shared_memory(process))
    if most:
        images = bench.collect(Image, "image", qos_profile_sensor_data)
        bench.wait_for(lambda: images)
        bench.wait_for(lambda: len(images) == images_after(bench, images))
        own = shared_memory(process)
    process.send(signal.SIGTERM)
    assert process.wait() == 0
    assert "Traceback" not in process.output
    assert not [path for path in own if path.exists() and path.name.endswith("_el")]
    stream.end()


def images_after(bench, images) -> int:
    """Number of images when half a second has passed without a new one."""
    deadline = time.monotonic() + 0.5
    while time.monotonic() < deadline:
        bench.executor.spin_once(timeout_sec=0.05)
    return len(images)
