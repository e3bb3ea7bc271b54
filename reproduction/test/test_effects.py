# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Both sides of a switch run on the same scenes, and each scene once."""

import re
from pathlib import Path

from reproduction import effects
from reproduction.runs.cells import System

NOTE = Path(__file__).parents[2] / "docs" / "interpretations.md"


def test_means_over_the_scenes_of_both_sides(monkeypatch):
    batches = []

    def run(batch):
        batches.append(batch)
        # 10 px on the first scene and 30 on the second, twice as much with the switch.
        return [
            {"metrics": {"rmse_px": (10.0 if cell.scene.name == "bar" else 30.0)
                         * (2 if "sigma" in dict(cell.system.settings) else 1)}}
            for cell in batch
        ]  # fmt: skip

    monkeypatch.setattr(effects, "run_together", run)
    effect = effects.Effect(7, System.of("PF", "pf"), {"sigma": 3.0}, ("bar", "overlap"))
    table = effects.table([effect])
    assert table.rows == (("7", "`sigma: 3.0`", "`pf` on bar, overlap", 20.0, 40.0),)
    assert [len(batch) for batch in batches] == [2] * 2 * len(effects.SEEDS)


def test_every_effect_is_of_a_listed_interpretation():
    listed = {int(n) for n in re.findall(r"^\| (\d+) \|", NOTE.read_text("utf-8"), re.MULTILINE)}
    assert {effect.number for effect in effects.EFFECTS} <= listed
    for effect in effects.EFFECTS:
        assert effect.system.but(effect.settings).parameters(0) != effect.system.parameters(0)
