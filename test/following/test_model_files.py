# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Networks that are fetched once, from a server on this machine."""

import hashlib
import resource
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import onnx_networks as networks
import pytest

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.detection.parameters import DetectorParameters
from vehicle_pf_tracker.following.detectors import detector_maker
from vehicle_pf_tracker.following.networks.model_files import model_file

CONTENT = bytes(range(256)) * 1000
SUM = hashlib.sha256(CONTENT).hexdigest()


class Handler(BaseHTTPRequestHandler):
    """Serves the file at /net.onnx, its half at /cut.onnx, and nothing else."""

    def do_GET(self):
        self.server.asked += 1
        if self.path not in {"/net.onnx", "/cut.onnx"}:
            self.send_error(404)
            return
        content = self.server.content
        self.send_response(200)
        self.send_header("Content-Length", str(len(content)))
        self.end_headers()
        self.wfile.write(content[: len(content) // 2] if "cut" in self.path else content)

    def log_message(self, *_):
        pass


@pytest.fixture
def server(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setenv("no_proxy", "127.0.0.1")
    with ThreadingHTTPServer(("127.0.0.1", 0), Handler) as server:
        server.asked, server.content = 0, CONTENT
        server.url = f"http://127.0.0.1:{server.server_port}"
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield server
        server.shutdown()


def kept(tmp_path):
    return [path for path in tmp_path.rglob("*") if path.is_file()]


def test_a_network_is_fetched_once_with_progress(server, tmp_path):
    shares = []
    url = f"{server.url}/net.onnx"
    path, digest = model_file(url, lambda _, share: shares.append(share))
    assert (path.read_bytes(), digest) == (CONTENT, SUM)
    assert path.name.endswith("net.onnx")
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    assert len(shares) > 2
    assert model_file(f"{url}#sha256={SUM.upper()}") == (path, SUM)
    assert (server.asked, kept(tmp_path)) == (1, [path])


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("cut.onnx", r"broke off after \d+ bytes; try again$"),
        ("none.onnx", r"none\.onnx: the server answers 404 Not Found$"),
        (f"net.onnx#sha256={'0' * 64}", rf"has the SHA-256 {SUM}, not 0000\d*; it is not kept$"),
        ("net.onnx#md5=12", "stands sha256= and 64 digits, not 'md5=12'$"),
    ],
)
def test_what_is_not_whole_or_not_as_demanded_is_not_kept(server, tmp_path, name, said):
    with pytest.raises(InputError, match=said):
        model_file(f"{server.url}/{name}")
    assert kept(tmp_path) == []


def test_a_kept_network_of_another_sum_is_refused_with_its_file(server):
    url = f"{server.url}/net.onnx"
    path, _ = model_file(url)
    path.write_bytes(b"other")
    with pytest.raises(InputError, match=rf"not {SUM}; delete {path} to fetch it again"):
        model_file(f"{url}#sha256={SUM}")


def test_without_a_network_it_is_one_sentence(server, tmp_path):
    server.shutdown()
    server.server_close()
    with pytest.raises(InputError, match=r"cannot be fetched: .*; without a network "):
        model_file(f"{server.url}/net.onnx")
    with pytest.raises(InputError, match="at no http or https address"):
        model_file("ftp://127.0.0.1/net.onnx")
    assert kept(tmp_path) == []


def test_a_full_disk_is_one_sentence_and_nothing_is_kept(server, tmp_path):
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, before[1]))
    try:
        with pytest.raises(InputError, match=r"cannot write .*net\.onnx: File too large"):
            model_file(f"{server.url}/net.onnx")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert kept(tmp_path) == []


def test_a_detector_is_made_from_a_url(server, tmp_path):
    pytest.importorskip("onnxruntime")
    server.content = networks.yolov8(tmp_path / "made.onnx").read_bytes()
    model = f"{server.url}/net.onnx"
    make = detector_maker(DetectorParameters(kind="model", model=model, input_size=networks.SIDE))
    assert make().form == "YOLOv8"
