# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Sessions of `apf` on the street, fed at the stamps of a steady camera."""

from vehicle_pf_tracker.parameters.configuration import SessionParameters, TargetParameters
from vehicle_pf_tracker.trackers.papers.apf import ApfParameters
from vehicle_pf_tracker.trackers.registry import VARIANTS
from vehicle_pf_tracker.trackers.session import Session

APF = VARIANTS["apf"]
PERIOD_NS = 40_000_000


def configured(box, **values):
    target = TargetParameters(box.x, box.y, box.width, box.height)
    return SessionParameters(target=target, **values)


def session(box=None, **values):
    settings = configured(box, **values) if box else SessionParameters(**values)
    return Session(APF, ApfParameters(), settings)


def feed(of, street, times, offset=0):
    return [of.feed(street.frame(t), (t + offset + 1) * PERIOD_NS) for t in times]


def positions(estimates):
    return [e.position if e else None for e in estimates]
