# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Live page of a node of many vehicles; only its owner can read the address."""

from __future__ import annotations

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.ros.node.journal import Journal
from vehicle_pf_tracker.ros.own_files import own_file, write_private
from vehicle_pf_tracker.showing.live_page import LivePage


def open_page(node: str, port: int, journal: Journal) -> LivePage | None:
    """Serve the page of the node of this full name; None where it cannot be.

    A port that cannot be had costs the page only.
    """
    try:
        page = LivePage(port)
    except InputError as error:
        journal.log.error(f"{error}; all vehicles are followed without the page")
        return None
    _tell_address(node, page.url, journal)
    return page


def _tell_address(node: str, url: str, journal: Journal) -> None:
    """Say where the address of the page is: logs and /rosout are read by others too."""
    path = own_file(node, "page.url")
    try:
        write_private(path, f"{url}\n")
    except OSError as error:
        words = f"its address cannot be written to {path}: {error.strerror or error}"
        journal.log.error(f"picture and counts are on a page, but {words}")
        return
    journal.log.info(f"picture and counts are at the address in {path}, which only you can read")
