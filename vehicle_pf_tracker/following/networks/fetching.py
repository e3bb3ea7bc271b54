# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Files from the internet, fetched once into the user's cache.

pooch keeps a file once it is whole and has its sum. It does not limit the size, resume a fetch that
broke off, or remove what a killed process has left; this module does all three.
"""

from __future__ import annotations

import fcntl
import hashlib
import importlib
import os
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO, Any
from urllib.parse import quote, unquote

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.outputs import output_errors
from vehicle_pf_tracker.core.progress import ShowShare, silent
from vehicle_pf_tracker.results.output_files import make_folder

_SECONDS = 30.0
"""Silence of a server after which it is given up: a slow one sends something meanwhile."""
_CHUNK = 1 << 16
"""Bytes between two reports of progress: some ten a second at the rate of a slow line."""
_BLOCK = 1 << 20
"""Bytes of a file that are summed at once, so that a large one needs no memory."""
MOST_BYTES = 2**31
"""Size of the largest file of a network: protobuf, which ONNX is written in, has no larger
ones."""
_LEFT_SECONDS = 7 * 86400.0
"""Age after which the part that a fetch has left, and none has resumed, is removed: a week, a
choice."""
_LONGEST_TAG = 60
"""Letters of an ETag, the server's name for a state of a file, that fit into the name of the part:
each may take three bytes there."""
_NO_RANGE = 416
"""Status of a server that has nothing after the part that is there already."""


def fetch(url: str, path: Path, demanded: str, progress: ShowShare = silent) -> None:
    """Fetch a file, which appears once it is whole and has the sum demanded.

    Where the server can, this resumes from the part that an earlier fetch has left.

    Parameters
    ----------
    url : str
        Address of the file, http or https.
    path : Path
        Place at which it is kept.
    demanded : str
        SHA-256 that it must have; empty where none is known.
    progress : ShowShare
        Shows the transfer.

    Raises
    ------
    InputError
        If it cannot be fetched or kept, has another sum, or pooch is not installed.
    """
    pooch, requests = _libraries()
    pooch.get_logger().setLevel("WARNING")  # it would print the sum
    make_folder(path.parent)
    # At each fetch, as no other moment is sure to come.
    _remove_leftovers(path.parent)
    download = _Download(url, path, progress, requests)
    with output_errors(path):
        try:
            pooch.retrieve(
                url,
                f"sha256:{demanded}" if demanded else None,
                fname=path.name,
                path=path.parent,
                downloader=download,
            )
        except ValueError as error:
            if isinstance(error, InputError) or not download.digest:
                raise
            raise InputError(
                f"the network {url} has the SHA-256 {download.digest}, not {demanded}; it is not "
                "kept"
            ) from None


def _libraries() -> tuple[Any, Any]:
    """Load pooch and requests, which it brings."""
    try:
        return importlib.import_module("pooch"), importlib.import_module("requests")
    except ImportError:
        raise InputError(
            "networks at an address need pooch: install the extra [video], "
            "pip install 'vehicle_pf_tracker[video]'; or give a file"
        ) from None


def sum_of(path: Path) -> str:
    """Return the SHA-256 of a file."""
    digest = hashlib.sha256()
    with path.open("rb") as file:
        while block := file.read(_BLOCK):
            digest.update(block)
    return digest.hexdigest()


class _Download:
    """Fetch of one file, which pooch calls with the file to fill.

    Attributes
    ----------
    digest : str
        SHA-256 of the whole file; empty before.
    """

    def __init__(self, url: str, path: Path, progress: ShowShare, requests: Any) -> None:
        self._url = url
        self._path = path
        self._progress = progress
        self._requests = requests
        self.digest = ""

    def __call__(self, url: str, output_file: str, _pooch: Any) -> None:
        """Fill the file, from the part that an earlier fetch has left."""
        try:
            with _reserved(self._part()) as part:
                if not self._fill(part, Path(output_file)) and part is not None:
                    part.unlink()  # it was no beginning of what the server has now
                    self._fill(None, Path(output_file))
        except self._requests.RequestException as error:
            answer = error.response
            if answer is not None:
                raise InputError(
                    f"the network {url}: the server answers {answer.status_code} {answer.reason}"
                ) from None
            raise InputError(
                f"the network {url} cannot be fetched: {_reason(error)}; without a network "
                f"connection, fetch it elsewhere and put it at {self._path}"
            ) from None
        self.digest = sum_of(Path(output_file))

    def _part(self) -> Path | None:
        """Return what an earlier fetch has left; None where there is nothing."""
        # The largest of several states of the server's file; whether it is still that one,
        # `If-Range` asks.
        parts = self._path.parent.glob(f"{self._path.name}.*.part")
        return max(parts, key=lambda part: part.stat().st_size, default=None)

    def _fill(self, part: Path | None, output: Path) -> bool:
        """Fetch into `part`, or a new one, and move it to `output`; False if it does not fit."""
        requests = self._requests
        done = part.stat().st_size if part else 0
        # Uncompressed: offsets and lengths are then those of the file.
        headers = {"Accept-Encoding": "identity"}
        if part is not None and done:
            tag = unquote(part.name.removesuffix(".part")[len(self._path.name) + 1 :])
            headers |= {"Range": f"bytes={done}-", "If-Range": tag}
        with requests.get(self._url, stream=True, timeout=_SECONDS, headers=headers) as answer:
            if answer.status_code == _NO_RANGE and part is not None:
                return False
            answer.raise_for_status()
            goes_on = answer.status_code == requests.codes.partial_content
            # It sends all: the file has changed, or the server knows no ranges.
            if not goes_on:
                done = 0
                part = self._new_part(answer.headers.get("ETag", ""), part)
            target = part or output
            length = answer.headers.get("Content-Length", "")
            total = done + int(length) if length.isdecimal() else None
            try:
                with target.open("ab" if goes_on else "wb") as file:
                    self._receive(answer.iter_content(_CHUNK), file, done, total)
            finally:
                if target is not output and not target.stat().st_size:
                    target.unlink()  # refused: nothing to resume from
        if target is not output:
            target.replace(output)
        return True

    def _new_part(self, tag: str, reserved: Path | None) -> Path | None:
        """Return a file to resume from later, named by the ETag of this state of the server's file.

        None where the server gives no such tag, or another process writes that file.
        """
        if not tag.startswith('"') or len(tag) > _LONGEST_TAG:
            return None
        part = self._path.with_name(f"{self._path.name}.{quote(tag, safe='')}.part")
        return part if part == reserved or not part.exists() else None

    def _receive(
        self, chunks: Iterator[bytes], file: IO[bytes], done: int, total: int | None
    ) -> None:
        """Write the chunks of a file that has `done` bytes already, of `total` if it is known."""
        # Twice: by what the server says before, and by what it sends below.
        if total is not None and total > MOST_BYTES:
            raise InputError(f"the network {self._url} has {total} bytes; no network is so large")
        try:
            for chunk in chunks:
                # A page to log in has status 200, and its markup begins with this; ONNX does not.
                if not done and chunk.lstrip()[:1] == b"<":
                    raise InputError(
                        f"the network {self._url} is a page, not a network: open the address in a "
                        "browser; a page to log in may be before it"
                    )
                done += file.write(chunk)
                if done > MOST_BYTES:
                    raise InputError(f"the network {self._url} does not end; it is not kept")
                self._progress(f"fetching {self._url}", done / total if total else None)
        except InputError:
            # A later fetch must not resume from what is refused.
            file.truncate(0)
            raise
        except self._requests.RequestException:
            # Without a length, a connection that broke has not sent all.
            total = total or done + 1
        if not done or (total is not None and done < total):
            raise InputError(f"the network {self._url} broke off after {done} bytes; try again")


@contextmanager
def _reserved(part: Path | None) -> Iterator[Path | None]:
    """Yield a part to resume from; None where there is none, or another process writes it."""
    if part is None:
        yield None
        return
    # filelock empties the file that it locks: each part would need another beside it, which a
    # killed process leaves.
    with part.open("ab") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            yield None
        else:
            yield part


def _reason(error: Exception) -> str:
    """Return the innermost reason of an error of requests, in a few words."""
    while isinstance(inner := (error.__cause__ or error.__context__), Exception):
        error = inner
    return str(getattr(error, "strerror", None) or error)


def _remove_leftovers(folder: Path) -> None:
    """Remove parts of files that no fetch has resumed, as of a process that was killed."""
    for path in [*folder.glob("*.part"), *folder.glob("tmp*")]:
        with suppress(OSError):
            if time.time() - path.stat().st_mtime > _LEFT_SECONDS:
                os.unlink(path)  # noqa: PTH108
