# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Visitors of a live page, for tests that have to know when one waits for a picture."""

import threading

from vehicle_pf_tracker.showing.live_page import LivePage


def when_one_waits(monkeypatch):
    """Event that is set as soon as somebody waits for the next picture of any page."""
    waits = threading.Event()

    def picture_seconds(_):
        # It is read by who waits, under the lock that the next picture is shown with.
        waits.set()
        return 30.0

    monkeypatch.setattr(LivePage, "picture_seconds", property(picture_seconds))
    return waits
