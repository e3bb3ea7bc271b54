# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Addresses of sources, as they may be shown: without user and password."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import PurePosixPath
from typing import Any
from urllib.parse import unquote

HIDDEN_MARK = "***"
"""Mark in place of a password."""
_SCHEME = r"(?<![A-Za-z0-9+.-])[0-9+.-]*[A-Za-z][A-Za-z0-9+.-]+:/{1,2}"
"""Beginning of an address; a path has one of the two slashes. It is looked for where a word begins
alone, since texts come from other programs: from each letter of a long one, it took minutes."""
_USERINFO = re.compile(
    # Up to the last @ before the path; a password may have another @ in it. Or one that has a
    # slash in it, which shows by no port before that slash.
    rf"({_SCHEME})(?:[^\s/?#]*@|[^\s/?#:@]*:(?!\d+(?:[/?#\s]|$))(?:\S{{0,500}}@|[^@\n]{{1,80}}@))"
)
_WHOLE_USERINFO = re.compile(rf"^({_SCHEME})(?:[^/?#]*@|[^/?#:@]*:(?!\d+[/?#]).*@)", re.DOTALL)
"""User and password of a text that is one address as a whole, where they may have spaces."""
_SECRET = re.compile(
    # Cameras take the password as part of the query, or of the path, with & or _ between the parts.
    r"(?i)((?:^|[?&;/_])(?:[a-z]{0,40}pass(?:word|wd|phrase)?|pwd|[a-z_-]{0,40}(?:token|key)|secret"
    r"|auth|sig|signature|x-amz-signature|x-amz-credential)=)[^&;\s\"'#]+"
)
_ADDRESS = re.compile(rf"{_SCHEME}\S+")


def without_passwords(text: str) -> str:
    """Replace the userinfo, and values called password or alike, of the addresses in a text."""
    hidden = _USERINFO.sub(rf"\1{HIDDEN_MARK}@", text)
    return _ADDRESS.sub(lambda found: _SECRET.sub(rf"\1{HIDDEN_MARK}", found[0]), hidden)


def shown(source: object) -> str:
    """Return a source, which is a path or one address as a whole, as it may be shown."""
    return without_passwords(_WHOLE_USERINFO.sub(rf"\1{HIDDEN_MARK}@", str(source)))


def shown_values(document: Any) -> Any:
    """Return plain values, of any nesting, with every text in them as it may be shown."""
    if isinstance(document, str):
        return shown(document)
    if isinstance(document, Mapping):
        return {key: shown_values(value) for key, value in document.items()}
    if isinstance(document, (list, tuple)):
        return [shown_values(value) for value in document]
    return document


def short_name(source: str) -> str:
    """Return a name for the results of a source: its last part, or the host of an address."""
    scheme = re.match(_SCHEME, source)
    if scheme is None:
        return PurePosixPath(source).stem
    host, _, path = shown(source)[scheme.end() :].partition("/")
    path = re.split(r"[?#]", path)[0]
    stem = PurePosixPath(unquote(path)).stem or re.split(r"[?#]", host)[0].rpartition("@")[2]
    return re.sub(r"[^\w.-]+", "_", stem).strip("_")
