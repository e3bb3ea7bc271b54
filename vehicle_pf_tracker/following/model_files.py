# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Files of networks: on this machine, or fetched once into the user's cache."""

from __future__ import annotations

import hashlib
import os
import re
from collections.abc import Callable, Iterator
from http.client import HTTPException
from pathlib import Path, PurePosixPath
from typing import TypeAlias
from urllib.error import HTTPError
from urllib.parse import unquote, urldefrag, urlsplit
from urllib.request import urlopen

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.results.output_files import make_folder, replacing

_SECONDS = 30.0
"""Silence of a server after which it is given up: a slow one sends something meanwhile."""
_CHUNK = 1 << 16
_UNSAFE = re.compile(r"[^A-Za-z0-9._-]")


Progress: TypeAlias = Callable[[str, float | None], None]
"""Takes words about a transfer, and its share done, None if unknown."""


def silent(words: str, share: float | None) -> None:
    """Show no progress."""


def model_file(model: str, progress: Progress = silent) -> tuple[Path, str]:
    """Return the file of a network, and its SHA-256.

    Parameters
    ----------
    model : str
        A path; or a URL, whose file is fetched unless the cache has it. At its end may stand
        ``#sha256=`` with the sum that the file must have.
    progress : Progress
        Shows the transfer.

    Raises
    ------
    InputError
        If there is none, it cannot be fetched or kept, or has another sum.
    """
    if not is_url(model):
        return Path(model), _sum_of(Path(model))
    url, demand = urldefrag(model)
    if urlsplit(url).scheme not in {"http", "https"}:
        raise InputError(f"the network {url} is at no http or https address")
    demand = demand.lower()
    if demand and not re.fullmatch(r"sha256=[0-9a-f]{64}", demand):
        raise InputError(f"after # of a network's URL stands sha256= and 64 digits, not {demand!r}")
    path = cached(url)
    if not path.is_file():
        _fetch(url, path, demand[7:], progress)
    found = _sum_of(path)
    _check(url, found, demand[7:], f"delete {path} to fetch it again")
    return path, found


def is_url(model: str) -> bool:
    """Tell whether a network is named by a URL."""
    return "://" in model


def cached(url: str) -> Path:
    """Return the path in the user's cache at which the file of a URL is kept."""
    cache = Path(os.environ.get("XDG_CACHE_HOME") or "~/.cache").expanduser()
    name = _UNSAFE.sub("_", unquote(PurePosixPath(urlsplit(url).path).name))[-80:]
    digest = hashlib.sha256(url.encode()).hexdigest()[:12]
    return cache / "vehicle_pf_tracker" / "models" / f"{digest}-{name}"


def _sum_of(path: Path) -> str:
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError:
        raise InputError(f"there is no network {path}") from None


def _check(url: str, found: str, demanded: str, remedy: str) -> None:
    if demanded and found != demanded:
        raise InputError(f"the network {url} has the SHA-256 {found}, not {demanded}; {remedy}")


def _fetch(url: str, path: Path, demanded: str, progress: Progress) -> None:
    """Fetch a file, which is there when it is whole and has the sum demanded."""
    make_folder(path.parent)
    with replacing(path) as partial:
        with partial.open("wb") as file:
            for chunk, share in _chunks(url):
                file.write(chunk)
                progress(f"fetching {url}", share)
        _check(url, _sum_of(partial), demanded, "it is not kept")


def _chunks(url: str) -> Iterator[tuple[bytes, float | None]]:
    """Yield the parts of a file, with the share of it that is there by then."""
    done = 0
    try:
        with urlopen(url, timeout=_SECONDS) as answer:  # noqa: S310 - the scheme was checked
            length = int(answer.headers.get("Content-Length") or 0)
            while chunk := answer.read(_CHUNK):
                done += len(chunk)
                yield chunk, done / length if length else None
    except HTTPError as error:
        raise InputError(
            f"the network {url}: the server answers {error.code} {error.reason}"
        ) from None
    except (OSError, HTTPException, ValueError) as error:
        reason = getattr(error, "reason", error)
        raise InputError(
            f"the network {url} cannot be fetched: {reason}; without a network connection, name a "
            "file"
        ) from None
    if done < length or not done:
        raise InputError(f"the network {url} broke off after {done} bytes; try again")
