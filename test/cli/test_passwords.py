# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Passwords in the addresses of sources and networks stand in no result and no message."""

import threading
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer

import cv2
import pytest
from small_recordings import TARGET, frame_of, write_video

from vehicle_pf_tracker.cli.main import main

SECRET = "hunter2"
needs_streams = pytest.mark.skipif(
    cv2.CAP_FFMPEG not in [int(one) for one in cv2.videoio_registry.getStreamBackends()],
    reason="this OpenCV reads no network streams",
)


class Quiet(SimpleHTTPRequestHandler):
    def log_message(self, *words):
        """Say nothing."""


@pytest.fixture
def server(tmp_path):
    """A server of a video, which does not ask for the password."""
    folder = tmp_path / "served"
    folder.mkdir()
    write_video(folder / "v.avi", map(frame_of, range(12)))
    with ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=folder)) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"admin:{SECRET}@127.0.0.1:{server.server_port}"
        server.shutdown()


def secrets_in(folder):
    return [
        path
        for path in folder.rglob("*")
        if SECRET in str(path) or (path.is_file() and SECRET.encode() in path.read_bytes())
    ]


@needs_streams
@pytest.mark.parametrize("verb", ["run", "traffic"])
def test_a_run_of_an_address_keeps_no_password(server, tmp_path, monkeypatch, capsys, verb):
    monkeypatch.chdir(tmp_path)
    words = ["--variant", "pf", "--target", TARGET] if verb == "run" else []
    assert main([verb, f"http://{server}/v.avi", *words]) == 0
    out, err = capsys.readouterr()
    assert SECRET not in out + err
    assert not secrets_in(tmp_path)
    (document,) = tmp_path.glob("results/*/run.json")
    assert f'"recording": "http://***@{server.partition("@")[2]}/v.avi"' in document.read_text()


@pytest.mark.parametrize(
    "words",
    [
        ("run", f"rtsp://admin:{SECRET}@127.0.0.1:1/x", "--target", TARGET),
        ("run", f"nothing://admin:{SECRET}@host", "--target", TARGET),
        ("pick", f"http://admin:{SECRET}@127.0.0.1:1/x"),
        ("import", f"http://admin:{SECRET}@127.0.0.1:1/x", "out"),
        ("traffic", "v.avi", "--model", f"http://admin:{SECRET}@127.0.0.1:1/n.onnx"),
        ("traffic", "v.avi", "--model", f"ftp://admin:{SECRET}@127.0.0.1:1/n.onnx"),
        (
            "traffic",
            "v.avi",
            "--detector",
            "model",
            "--set",
            f"detector.model=http://u:{SECRET}@h:x/n.onnx",
        ),
        ("evaluate", f"http://admin:{SECRET}@127.0.0.1:1/x", "-o", "out"),
        (f"http://admin:{SECRET}@127.0.0.1:1/x",),
        ("run", "v.avi", "--target", f"http://admin:{SECRET}@127.0.0.1:1/x"),
    ],
)
def test_an_error_names_no_password(tmp_path, monkeypatch, capfd, words):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    write_video(tmp_path / "v.avi", map(frame_of, range(12)))
    assert main(list(words)) != 0
    out, err = capfd.readouterr()
    assert "error" in err and "Traceback" not in err
    assert SECRET not in out + err
    assert not secrets_in(tmp_path)
