# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The model that is fitted is the one that nodes use, and the fit finds what made the errors."""

from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("scipy", reason="the extra evaluation is not installed")

from laboratory.uncertainty.fit import fit
from laboratory.uncertainty.picture import draw
from laboratory.uncertainty.runs import INSIDE_95, RUN_COLUMNS, Runs, runs_of
from laboratory.uncertainty.table_module import fitted_table
from laboratory.uncertainty.tracking import rows_of
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.configuration import SessionParameters
from vehicle_pf_tracker.parameters.table import from_mapping
from vehicle_pf_tracker.scenes.catalogue import make_scene
from vehicle_pf_tracker.trackers.localisation import Localisation
from vehicle_pf_tracker.trackers.registry import VARIANTS
from vehicle_pf_tracker.trackers.session import Session
from vehicle_pf_tracker.trackers.uncertainty_table import CALIBRATIONS


def test_runs_have_the_covariances_of_the_node(tmp_path):
    frames = list(make_scene("bridge", seed=1).frames())[:75]
    variant = VARIANTS["apf"]
    table = np.array(list(rows_of(variant, frames, 4)))
    assert table.shape == (75, len(RUN_COLUMNS))
    np.save(tmp_path / "apf.bridge.4.npy", table)
    squares, areas = Runs([tmp_path / "apf.bridge.4.npy"]).calibrated(CALIBRATIONS["apf"])

    box = frames[0].truth.box
    values = {f"target.{name}": getattr(box, name) for name in ("x", "y", "width", "height")}
    session = Session(variant, variant.parameters(seed=4), from_mapping(SessionParameters, values))
    local = Localisation("apf", session.settings.road)
    modes = set()
    for index, each in enumerate(frames):
        estimate = session.feed(each.frame, each.truth.stamp_ns)
        local.follow(estimate, each.truth.stamp_ns, session.tracker.frame_period)
        modes.add(estimate.mode)
        if index:
            error = np.subtract(estimate.position, each.truth.box.centre)
            expected = error @ np.linalg.solve(local.covariance, error)
            assert squares[index - 1] == pytest.approx(expected)
            assert areas[index - 1] == pytest.approx(np.linalg.det(local.covariance))
    assert len(modes) > 1


def made(folder: Path, name: str, seed: int) -> Path:
    """Run of errors from a known spread: 2 clouds while visible, growing while hidden."""
    rng = np.random.default_rng(seed)
    table = np.zeros((800, len(RUN_COLUMNS)))
    column = {name: index for index, name in enumerate(RUN_COLUMNS)}
    table[:, column["stamp"]] = np.arange(800) * 0.1
    table[:, column["xx"]] = table[:, column["yy"]] = rng.uniform(1, 9, 800)
    table[:, [column["width"], column["height"]]] = 20.0
    table[:, column["period"]] = 0.1
    table[:, column["confidence"]] = 1.0
    hidden = np.arange(800) % 40 >= 20
    table[hidden, column["mode"]] = 1
    since = (np.arange(800) % 40 - 19) * 0.1 * hidden
    deviation = np.sqrt(4 * table[:, column["xx"]] * ~hidden + (20 * since) ** 2 + hidden * 1.0)
    for axis in ("error_x", "error_y"):
        table[:, column[axis]] = rng.normal(size=800) * deviation
    path = folder / f"{name}.made.{seed}.npy"
    np.save(path, table)
    return path


def test_the_fit_covers_runs_that_it_has_not_seen(tmp_path):
    found = fit(Runs([made(tmp_path, "pf", seed) for seed in range(3)]))
    assert found.visible.cloud == pytest.approx(2.0, rel=0.15)
    assert found.visible.growth == 0
    squares, _ = Runs([made(tmp_path, "pf", seed) for seed in range(10, 13)]).calibrated(found)
    assert (squares <= INSIDE_95).mean() == pytest.approx(0.95, abs=0.02)


def test_the_table_is_a_module_that_says_the_same(tmp_path):
    made(tmp_path, "pf", 0)
    text = fitted_table(tmp_path, "# licence\n")
    scope: dict[str, object] = {}
    exec(compile(text, "table", "exec"), scope)
    assert set(scope["CALIBRATIONS"]) == {"*", "pf"}
    assert scope["CALIBRATIONS"]["pf"] == fit(Runs(runs_of(tmp_path)["pf"]))


def test_the_picture_is_drawn_without_runs_of_the_scene_that_it_shows(tmp_path):
    made(tmp_path, "fusion", 0)
    draw(tmp_path / "uncertainty.png", runs_of(tmp_path))
    assert (tmp_path / "uncertainty.png").stat().st_size > 0


def test_folders_without_runs(tmp_path):
    with pytest.raises(InputError, match="has no runs"):
        runs_of(tmp_path)
