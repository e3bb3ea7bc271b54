# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The live page of a verb: its address, and its serving, whose failure costs the page only."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass

from vehicle_pf_tracker.cli.console import tell_notices
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.showing.live_page import PAGE_NAME, LivePage
from vehicle_pf_tracker.showing.page_server import LOCAL_ADDRESS
from vehicle_pf_tracker.showing.side_products import SideProducts

_LAST_PORT = 65535
"""Largest number of a port: they have 16 bits."""


@dataclass(frozen=True, slots=True)
class ServeAddress:
    """Address at which a page is served.

    Attributes
    ----------
    port : int
        Port; 0 for any free one.
    host : str
        Address to listen at.
    """

    port: int = 0
    host: str = LOCAL_ADDRESS

    @classmethod
    def parse(cls, text: str) -> ServeAddress:
        """Read ``8080``, ``0.0.0.0:8080`` or ``[::]:8080``.

        Raises
        ------
        InputError
            If it is none of them.
        """
        host, _, port = text.rpartition(":")
        if not (port.isascii() and port.isdecimal() and int(port) <= _LAST_PORT):
            raise InputError(f"{text!r} is not [HOST:]PORT, with a port from 0 to {_LAST_PORT}")
        return cls(int(port), host.strip("[]") or LOCAL_ADDRESS)


def parse_token(text: str) -> str:
    """Read the secret part of an address.

    Raises
    ------
    InputError
        If it is short, or has letters that an address cannot have as they are.
    """
    if not re.fullmatch(r"[A-Za-z0-9_-]{8,100}", text):
        raise InputError("a token has 8 to 100 letters, digits, - and _")
    return text


@contextmanager
def served(
    address: ServeAddress | None, token: str | None, side: SideProducts
) -> Iterator[LivePage | None]:
    """Serve a page until the end of the block, and print its address.

    None where no address is given, or the page cannot be served there, which is reported at once.
    """
    page = None
    if address is not None:
        with side.attempt(PAGE_NAME):
            page = LivePage(address.port, address.host, token or "")
    if page is None or address is None:
        tell_notices(side.notices)
        yield None
        return
    where = "on this machine"
    if address.host != LOCAL_ADDRESS:
        where = "of any machine that reaches this one; it is not encrypted, so put a proxy with TLS"
        where += " before it where others listen"
    print(f"open {page.url} in a browser {where}", flush=True)
    with closing(page):
        yield page
