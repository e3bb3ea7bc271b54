# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Recordings at URLs, from a real HTTP server and from fsspec's memory."""

import functools
import threading
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer

import numpy as np
import pytest

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.grid.sources import find_recordings
from vehicle_pf_tracker.recordings.bags.reader import Recording
from vehicle_pf_tracker.recordings.bags.writer import RecordingWriter
from vehicle_pf_tracker.recordings.recording_names import is_url
from vehicle_pf_tracker.recordings.url_copies import local_copy, recordings_at

fsspec = pytest.importorskip("fsspec")
FRAME = np.full((24, 32, 3), 90, np.uint8)


def write(path):
    path.parent.mkdir(parents=True, exist_ok=True)
    with RecordingWriter(path) as writer:
        writer.write_image(1, FRAME)
    return path


@pytest.fixture
def server(tmp_path):
    """The address of a server of `tmp_path`, and the paths that were asked for."""
    asked = []

    class Handler(SimpleHTTPRequestHandler):
        def log_message(self, *_):
            asked.append(self.path)

    handler = functools.partial(Handler, directory=str(tmp_path))
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as httpd:
        threading.Thread(target=httpd.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{httpd.server_port}", asked
        httpd.shutdown()


def test_an_mcap_file_over_http_is_copied_once(server, tmp_path):
    address, asked = server
    file = next(write(tmp_path / "east").glob("*.mcap"))
    url = f"{address}/east/{file.name}"
    path = local_copy(url)
    assert path.read_bytes() == file.read_bytes()
    count = len(asked)
    assert local_copy(url) == path
    assert len(asked) == count


@pytest.mark.parametrize("protocol", ["file://", "memory://"])
def test_a_folder_of_recordings_is_spread_out(protocol, tmp_path):
    for name in ("east", "west"):
        write(tmp_path / name)
    (tmp_path / "notes.txt").write_text("no recording")
    url = f"file://{tmp_path}"
    if protocol == "memory://":
        url = f"memory://{tmp_path.name}"
        fsspec.filesystem("memory").put(str(tmp_path), f"/{tmp_path.name}", recursive=True)
    found = recordings_at(url)
    assert [name.rpartition("/")[2] for name in found] == ["east", "west"]
    assert find_recordings([url]) == found
    assert recordings_at(found[0]) == [found[0]]
    (frame,) = Recording(local_copy(found[0])).frames()
    np.testing.assert_array_equal(frame.frame, FRAME)


@pytest.mark.parametrize(
    ("url", "sentence"),
    [
        ("file:///nothing/here", "there is no recording file:///nothing/here"),
        ("nonsense://a/b", "nonsense"),
        ("s3://bucket/rec", "s3fs"),
        ("http://127.0.0.1:9/rec.mcap", "cannot read the recording|there is no recording"),
        ("https://me:secret@example.org/rec", "must not have a password"),
    ],
)
def test_what_cannot_be_read_is_one_sentence(url, sentence):
    with pytest.raises(InputError, match=sentence) as error:
        recordings_at(url)
    assert "secret" not in str(error.value)


def test_an_empty_folder_holds_no_recording(tmp_path):
    with pytest.raises(InputError, match="is not a recording and holds none"):
        recordings_at(f"file://{tmp_path}")


@pytest.mark.parametrize(("location", "expected"), [("a/b", False), ("s3://a/b", True)])
def test_a_url_is_told_from_a_path(location, expected):
    assert is_url(location) == expected
