# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`track` and its table: as `run` writes it, in pandas, in a notebook."""

import ast
import base64
import csv
import json
import re
from pathlib import Path

import cv2
import numpy as np
import pytest
from small_recordings import TARGET, record

from vehicle_pf_tracker import Box, InputError, track
from vehicle_pf_tracker.cli.main import main
from vehicle_pf_tracker.showing.target_drawing import MODE_COLOURS

NOTEBOOK = Path(__file__).parents[2] / "docs" / "example.ipynb"


@pytest.fixture(scope="module")
def rec(tmp_path_factory):
    return record(tmp_path_factory.mktemp("library") / "rec")


def table_of(path):
    """Rows of a file of estimates, without the time that a step took."""
    with path.open() as file:
        return [{**row, "step_ms": ""} for row in csv.DictReader(file)]


def test_its_table_is_that_of_run(rec, tmp_path):
    words = ["--variant", "pf", "--seed", "3", "--set", "num_particles=50", "--target", TARGET]
    assert main(["run", str(rec), *words, "-o", str(tmp_path / "out")]) == 0
    box = [float(number) for number in TARGET.split(",")]
    track(rec, box, "pf", seed=3, num_particles=50).to_csv(tmp_path / "own.csv")
    expected = table_of(tmp_path / "out" / "estimates.csv")
    assert table_of(tmp_path / "own.csv") == expected
    assert len(expected) == 12


def test_without_a_target_it_starts_on_the_first_true_box(rec, tmp_path):
    later = record(tmp_path / "later", truths=range(3, 12))
    estimates = track(later, variant="pf")
    assert [row.mode for row in estimates[:4]] == ["WAITING"] * 3 + ["TRACKING"]
    assert estimates[3].position == (22.0, 30.0)
    with pytest.raises(InputError, match="has no truth to start on; give the vehicle's box"):
        track(record(tmp_path / "none", truths=()))
    with pytest.raises(InputError, match=r"\(8, 24\) is not left, top, width and height in px"):
        track(rec, (8, 24))
    assert track(rec, Box(8, 24, 16, 12), "ms")[0].box == Box(8, 24, 16, 12)


def test_a_data_frame_has_a_row_for_each_frame(rec):
    pytest.importorskip("pandas")
    found = track(rec, variant="ms")
    frame = found.to_pandas()
    assert list(frame.columns[:4]) == ["frame", "stamp_ns", "x", "y"]
    assert frame["x"].tolist() == [row.x for row in found]


def test_an_estimate_is_drawn_on_its_own_frame(rec):
    estimates = track(rec, variant="ms")
    shown = estimates.show(9)
    row = shown.row
    assert row.frame == 9
    right, bottom = int(row.x + row.width / 2), int(row.y + row.height / 2)
    assert tuple(shown.picture[bottom, right]) == MODE_COLOURS["TRACKING"]
    png = base64.b64decode(re.search(r"base64,([^\"]+)", shown._repr_html_())[1])
    decoded = cv2.imdecode(np.frombuffer(png, np.uint8), cv2.IMREAD_COLOR)[:, :, ::-1]
    assert np.array_equal(decoded, shown.picture)
    with pytest.raises(InputError, match="there is no frame 99; the source has 12"):
        estimates.show(99)


def test_the_example_notebook_runs(tmp_path, monkeypatch, capsys):
    notebook = json.loads(NOTEBOOK.read_text(encoding="utf-8"))
    cells = ["".join(cell["source"]) for cell in notebook["cells"] if cell["cell_type"] == "code"]
    monkeypatch.chdir(tmp_path)
    names, shown = {}, []
    for cell in cells:
        *before, last = ast.parse(cell).body
        exec(compile(ast.Module(before, []), NOTEBOOK.name, "exec"), names)
        if isinstance(last, ast.Expr):
            shown.append(eval(compile(ast.Expression(last.value), NOTEBOOK.name, "eval"), names))
        else:
            exec(compile(ast.Module([last], []), NOTEBOOK.name, "exec"), names)
    pictures = [one._repr_html_() for one in shown if hasattr(one, "_repr_html_")]
    assert re.match(r"<p>TRACKING .*, OCCLUDED .*, TRACKING .*</p><img ", pictures[0])
    assert pictures[1].startswith("<img ")
    assert re.search(r"hidden in frames \d+ to \d+$", capsys.readouterr().out.strip())
    assert not any(cell.get("outputs") for cell in notebook["cells"])
