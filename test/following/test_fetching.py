# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Fetching that breaks off, goes on, is lied to, or never ends."""

import hashlib
import os
import re
import subprocess
import sys
import threading
import time
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import pytest

pytest.importorskip("pooch", reason="the extra [video] is not installed")

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.following.networks import fetching
from vehicle_pf_tracker.following.networks.model_files import cached, model_file
from vehicle_pf_tracker.following.networks.opened_network import open_network

CONTENT = bytes(range(8, 256)) * 4000
SUM = hashlib.sha256(CONTENT).hexdigest()


class Handler(BaseHTTPRequestHandler):
    """Serves `server.content`, in the manner that the server's fields say."""

    def do_GET(self):
        server = self.server
        server.asked.append(self.headers.get("Range"))
        begin, content = 0, server.content
        goes_on = server.tag and self.headers.get("If-Range") == server.tag
        if self.headers.get("Range") and goes_on:
            begin = int(re.match(r"bytes=(\d+)-", self.headers["Range"])[1])
        self.send_response(206 if begin else 200)
        self.send_header("Content-Type", server.kind)
        if server.tag:
            self.send_header("ETag", server.tag)
        if server.states_length:
            self.send_header("Content-Length", str(server.claimed or len(content) - begin))
        self.end_headers()
        end = server.breaks_off.pop(0) if server.breaks_off else len(content)
        try:
            self.wfile.write(content[begin:end])
            while server.endless:
                self.wfile.write(CONTENT)
            if server.waits:
                server.waits.wait(30)
        except OSError:
            pass

    def log_message(self, *_):
        pass


@pytest.fixture
def server(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setenv("no_proxy", "127.0.0.1")
    with ThreadingHTTPServer(("127.0.0.1", 0), Handler) as server:
        server.asked, server.content, server.kind = [], CONTENT, "application/octet-stream"
        server.tag, server.breaks_off, server.states_length = '"v1"', [], True
        server.claimed, server.endless, server.waits = 0, False, None
        server.url = f"http://127.0.0.1:{server.server_port}/net.onnx"
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield server
        server.shutdown()


def kept(tmp_path):
    return sorted(
        path for path in (tmp_path / "cache" / "vehicle_pf_tracker").rglob("*") if path.is_file()
    )


def test_a_fetch_that_broke_off_goes_on(server, tmp_path):
    server.breaks_off = [400_000]
    with pytest.raises(InputError, match=r"broke off after \d+ bytes; try again"):
        model_file(server.url)
    (part,) = kept(tmp_path)
    done = part.stat().st_size
    assert part.suffix == ".part" and 0 < done <= 400_000
    shares = []
    path, digest = model_file(server.url, lambda _, share: shares.append(share))
    assert (path.read_bytes(), digest) == (CONTENT, SUM)
    assert server.asked == [None, f"bytes={done}-"]
    assert shares[0] > done / len(CONTENT) and shares[-1] == 1.0
    assert kept(tmp_path) == [path]


def test_a_file_that_changed_meanwhile_is_fetched_anew(server, tmp_path):
    server.breaks_off = [400_000]
    with pytest.raises(InputError, match="broke off"):
        model_file(server.url)
    server.content, server.tag = CONTENT[::-1], '"v2"'
    path, _ = model_file(server.url)
    assert path.read_bytes() == CONTENT[::-1]
    assert path in kept(tmp_path)


@pytest.mark.parametrize("tag", ["", 'W/"v1"', '"' + "v" * 500 + '"'])
def test_without_a_name_of_the_state_nothing_is_gone_on_with(server, tmp_path, tag):
    server.breaks_off, server.tag = [400_000], tag
    with pytest.raises(InputError, match="broke off"):
        model_file(server.url)
    assert kept(tmp_path) == []
    assert model_file(server.url)[1] == SUM
    assert server.asked == [None, None]


def test_what_went_on_wrongly_is_not_kept(server, tmp_path):
    server.breaks_off = [400_000]
    with pytest.raises(InputError, match="broke off"):
        model_file(f"{server.url}#sha256={SUM}")
    server.content = CONTENT[::-1]  # under the same name of its state
    with pytest.raises(InputError, match=rf"has the SHA-256 .*, not {SUM}; it is not kept"):
        model_file(f"{server.url}#sha256={SUM}")
    assert kept(tmp_path) == []


@pytest.mark.parametrize("page", [b"<html>log in</html>", b"\n <!DOCTYPE html>", b"<?xml?>"])
def test_a_page_is_not_kept(server, tmp_path, page):
    server.content = page
    for _ in range(2):
        with pytest.raises(InputError, match="is a page, not a network"):
            model_file(server.url)
    assert len(server.asked) == 2 and kept(tmp_path) == []


def test_what_cannot_be_loaded_is_not_kept(server, tmp_path):
    pytest.importorskip("onnxruntime")
    for _ in range(2):
        with pytest.raises(InputError, match=r"cannot be loaded: .*; it is not kept"):
            open_network(server.url)
    assert len(server.asked) == 2 and kept(tmp_path) == []


def test_what_cannot_be_loaded_and_is_as_demanded_is_kept(server, tmp_path):
    pytest.importorskip("onnxruntime")
    with pytest.raises(InputError, match="cannot be loaded: "):
        open_network(f"{server.url}#sha256={SUM}")
    assert kept(tmp_path) == [cached(server.url)]


def test_a_size_beyond_every_network_is_refused_at_once(server, tmp_path):
    server.claimed = 10**13
    with pytest.raises(InputError, match=r"has 10{13} bytes; no network is so large"):
        model_file(server.url)
    assert kept(tmp_path) == []


@pytest.mark.parametrize("tag", ["", '"v1"'])
def test_a_file_that_never_ends_is_given_up(server, tmp_path, monkeypatch, tag):
    monkeypatch.setattr(fetching, "MOST_BYTES", 3 * len(CONTENT))
    server.endless, server.states_length, server.tag = True, False, tag
    with pytest.raises(InputError, match="does not end; it is not kept"):
        model_file(server.url)
    server.endless = False
    assert kept(tmp_path) == []


def test_an_empty_file_is_not_kept(server, tmp_path):
    server.content = b""
    with pytest.raises(InputError, match="broke off after 0 bytes"):
        model_file(server.url)
    assert kept(tmp_path) == []


def test_what_a_killed_process_left_is_gone_on_with_or_removed(server, tmp_path):
    server.breaks_off, server.waits = [400_000], threading.Event()
    code = "import sys; from vehicle_pf_tracker.following.networks.model_files import model_file; "
    code += "model_file(sys.argv[1])"
    process = subprocess.Popen([sys.executable, "-c", code, server.url])
    until = time.monotonic() + 60
    while not any(path.suffix == ".part" and path.stat().st_size for path in kept(tmp_path)):
        assert time.monotonic() < until
        time.sleep(0.05)
    process.kill()
    process.wait()
    server.waits.set()
    for path in kept(tmp_path):
        if path.suffix != ".part":
            os.utime(path, (0, 0))  # an empty file of pooch's, of long ago
    assert model_file(server.url)[1] == SUM
    assert server.asked[1] is not None
    assert kept(tmp_path) == [cached(server.url)]


def test_parts_that_nobody_went_on_with_are_removed(server, tmp_path):
    folder = cached(server.url).parent
    folder.mkdir(parents=True)
    for name, age in (("old.part", 8 * 86400), ("new.part", 3600)):
        (folder / name).touch()
        os.utime(folder / name, (time.time() - age,) * 2)
    path, _ = model_file(server.url)
    assert kept(tmp_path) == sorted([path, folder / "new.part"])


def test_two_processes_fetch_beside_each_other(server, tmp_path):
    server.breaks_off = [400_000]
    with pytest.raises(InputError, match="broke off"):
        model_file(server.url)
    (part,) = kept(tmp_path)
    with part.open("ab") as file:
        fetching.fcntl.flock(file, fetching.fcntl.LOCK_EX)  # the other process
        assert model_file(server.url)[1] == SUM
    assert part.exists()


@pytest.mark.parametrize(
    "address",
    ["http://[::1", "http://[::1]:x/n", "http://h:99999/n", "http://", "https:///n.onnx",
     "ftp://h/n.onnx", "file:///etc/passwd", "http://a b/n.onnx", "http://\x00/n"],
)  # fmt: skip
def test_an_address_that_cannot_be_is_one_sentence(tmp_path, monkeypatch, address):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    with pytest.raises(InputError, match=r"^the network "):
        model_file(address)
    assert kept(tmp_path) == []
