# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Files of networks, by path, address or name."""

from __future__ import annotations

import hashlib
import os
import re
from pathlib import Path, PurePosixPath
from urllib.parse import unquote, urldefrag, urlsplit

from vehicle_pf_tracker.core.errors import InputError, suggestion
from vehicle_pf_tracker.core.progress import ShowShare, silent
from vehicle_pf_tracker.following.networks.fetching import fetch, sum_of
from vehicle_pf_tracker.following.networks.known_networks import KNOWN_NETWORKS, installed
from vehicle_pf_tracker.recordings.recording_names import is_url

_UNSAFE = re.compile(r"[^A-Za-z0-9._-]")
"""Letters of a URL that no file name gets."""
_LONGEST_NAME = 80
"""Letters of a file's own name that are kept: with sum and endings less than the 255 of Linux."""


def model_file(model: str, progress: ShowShare = silent) -> tuple[Path, str]:
    """Return the file of a network, and its SHA-256.

    Parameters
    ----------
    model : str
        A path; a name of `KNOWN_NETWORKS`; or a URL, at whose end ``#sha256=`` may stand with the
        sum that the file must have. What a name or a URL means is fetched unless the cache has it.
    progress : ShowShare
        Shows the transfer.

    Raises
    ------
    InputError
        If there is none, it cannot be fetched or kept, or has another sum.
    """
    if model in KNOWN_NETWORKS:
        brought = installed(model)
        if brought is not None:
            return brought, _sum_of(brought)
        model = KNOWN_NETWORKS[model].address
    if not is_url(model):
        return Path(model), _sum_of(Path(model))
    url, demand = urldefrag(model)
    demand = demand.lower()
    if demand and not re.fullmatch(r"sha256=[0-9a-f]{64}", demand):
        raise InputError(f"after # of a network's URL stands sha256= and 64 digits, not {demand!r}")
    demanded = demand.removeprefix("sha256=")
    path = cached(url)
    if not path.is_file():
        fetch(url, path, demanded, progress)
    digest = _sum_of(path)
    # Also of a file in the cache: it may have been kept when no sum was demanded.
    if demanded and digest != demanded:
        raise InputError(
            f"the network {url} has the SHA-256 {digest}, not {demanded}; delete {path} to fetch "
            "it again"
        )
    return path, digest


def is_fetched(model: str) -> bool:
    """Test whether a network is one that is fetched, by a URL or a name."""
    return model in KNOWN_NETWORKS or is_url(model)


def discard(model: str) -> str:
    """Remove what the cache has of a network that cannot be used; returns words about it.

    A file whose sum was demanded is as it should be, and stays.
    """
    url, demand = urldefrag(model)
    if not is_url(url) or demand:
        return ""
    path = cached(url)
    path.unlink(missing_ok=True)
    return "; it is not kept"


def cached(url: str) -> Path:
    """Return the path in the user's cache at which the file of a URL is kept.

    Raises
    ------
    InputError
        If it is no address.
    """
    try:
        parts = urlsplit(url)
        is_usable = parts.scheme in {"http", "https"} and bool(parts.hostname)
        # Read, as only this raises for a port that is no number.
        _ = parts.port
    except ValueError as error:  # brackets, a port that is no number
        raise InputError(f"the network {url} has no address that can be read: {error}") from None
    if not is_usable:
        raise InputError(f"the network {url} is at no http or https address")
    cache = Path(os.environ.get("XDG_CACHE_HOME") or "~/.cache").expanduser()
    name = _UNSAFE.sub("_", unquote(PurePosixPath(parts.path).name))[-_LONGEST_NAME:]
    # 48 bits of the whole URL: files of one name from two places do not meet.
    digest = hashlib.sha256(url.encode()).hexdigest()[:12]
    return cache / "vehicle_pf_tracker" / "models" / f"{digest}-{name}"


def _sum_of(path: Path) -> str:
    """Return the SHA-256 of a file; without one, the error names the known networks."""
    if path.exists() and not path.is_file():
        raise InputError(f"the network {path} is not a regular file")
    try:
        return sum_of(path)
    except OSError:
        meant = suggestion(str(path), KNOWN_NETWORKS) if path.suffix != ".onnx" else ""
        raise InputError(
            f"there is no network {path}{meant}; give a file, its URL, or one of the names "
            f"{', '.join(KNOWN_NETWORKS)}"
        ) from None
