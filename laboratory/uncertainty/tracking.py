# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Runs of variants over the scenes, each scene as it is and from other cameras."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from laboratory.scenes import LABORATORY_SCENES, make_scene
from vehicle_pf_tracker.parameters.configuration import SessionParameters, TargetParameters
from vehicle_pf_tracker.parameters.table import from_mapping, specs
from vehicle_pf_tracker.scenes.scene import SceneFrame
from vehicle_pf_tracker.trackers.estimate import Estimate, Mode
from vehicle_pf_tracker.trackers.registry import VARIANTS, Variant
from vehicle_pf_tracker.trackers.session import Session
from vehicle_pf_tracker.trackers.uncertainty import cloud_covariance

CAMERAS: dict[str, dict[str, object]] = {
    "": {},
    "_rough": {"disturbance": "rough"},
    "_going": {"heading": "going", "lens": "barrel"},
    "_mast": {"mount": "mast", "lens": "barrel"},
    "_mast_going": {"mount": "mast", "heading": "going"},
}
"""Settings of a scene, by what they add to its name; the last three are those of `road`."""


def keep_runs(
    folder: Path, variants: Sequence[str], scenes: Sequence[str], seeds: Sequence[int]
) -> None:
    """Run variants over scenes, and keep each run in the folder; one that is there is not rerun."""
    folder.mkdir(parents=True, exist_ok=True)
    for seed in seeds:
        for name, addition, settings in _views(scenes):
            # Asked before the scene is made: one that no run needs is not rendered.
            left = [
                (VARIANTS[variant], folder / f"{variant}.{name}{addition}.{seed}.npy")
                for variant in variants
                if not (folder / f"{variant}.{name}{addition}.{seed}.npy").exists()
            ]
            if left:
                # Once for all variants, which so see the very same images.
                frames = list(make_scene(name, seed=seed, settings=settings).frames())
                for variant, path in left:
                    np.save(path, np.array(list(rows_of(variant, frames, seed))))
                print(f"{name}{addition}, seed {seed}", file=sys.stderr, flush=True)


def _views(names: Sequence[str]) -> Iterator[tuple[str, str, dict[str, object]]]:
    """List each scene with every camera that it knows: its name, addition to it, and settings."""
    for name in names:
        known = specs(LABORATORY_SCENES[name].parameters)
        for addition, settings in CAMERAS.items():
            # A scene that does not know a setting has no such view.
            if not settings or all(
                key in known and value in known[key].choices for key, value in settings.items()
            ):
                yield name, addition, settings


def rows_of(variant: Variant, frames: Sequence[SceneFrame], seed: int) -> Iterator[Any]:
    """Track a scene, and give for each frame the numbers of `RUN_COLUMNS`."""
    box = frames[0].truth.box
    target = TargetParameters(box.x, box.y, box.width, box.height)
    session = Session(
        variant,
        from_mapping(variant.parameters, {"seed": seed}),
        SessionParameters(target=target),
    )
    for each in frames:
        estimate = session.feed(each.frame, each.truth.stamp_ns)
        # A target was given, and so there is an estimate from the first frame on.
        assert estimate is not None
        yield _row(estimate, each, session.tracker.frame_period)


def _row(estimate: Estimate, each: SceneFrame, period: float) -> tuple[float, ...]:
    truth = each.truth
    x, y = estimate.position
    true_x, true_y = truth.box.centre
    # Symmetric: the element below the diagonal is left out.
    (xx, xy), (_, yy) = cloud_covariance(estimate)
    return (
        truth.stamp_ns * 1e-9,
        x - true_x,
        y - true_y,
        xx,
        xy,
        yy,
        estimate.box.width,
        estimate.box.height,
        *estimate.velocity,
        period,
        list(Mode).index(estimate.mode),
        estimate.confidence,
        int(truth.occlusion),
    )
