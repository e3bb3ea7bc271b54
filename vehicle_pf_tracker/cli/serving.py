# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The live page of a verb, whose failure costs the page only."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing, contextmanager

from vehicle_pf_tracker.cli.console import tell_notices
from vehicle_pf_tracker.cli.tracking_options import ServeAddress
from vehicle_pf_tracker.showing.live_page import PAGE_NAME, LivePage
from vehicle_pf_tracker.showing.page_server import LOCAL_ADDRESS
from vehicle_pf_tracker.showing.side_products import SideProducts


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
