# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import pytest
from evaluation_samples import FRAMES, NO_BASELINES, SEEDS

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.evaluation.evaluation_folder import (
    EvaluationFolder,
    cell_folder,
    read_document,
    read_truth,
    safe_name,
    write_truth,
)


@pytest.fixture
def folder(made_evaluation):
    return made_evaluation


def test_the_plan(folder):
    evaluation = EvaluationFolder(folder)
    assert [entry.name for entry in evaluation.recordings] == ["bridge", "free"]
    assert [entry.kind for entry in evaluation.systems] == ["pf", "ms", "apf", "baseline:csrt"]
    assert dict(evaluation.systems[0].overrides) == {"num_particles": 40}
    assert evaluation.seeds == SEEDS


def test_cells_have_rows_or_a_reason(folder):
    evaluation = EvaluationFolder(folder)
    rows, run = evaluation.cell("free", "pf", 1)
    assert len(rows) == FRAMES
    assert run["seed"] == 1
    with pytest.raises(InputError, match=NO_BASELINES):
        evaluation.cell("free", "baseline:csrt", 0)
    with pytest.raises(InputError, match="it was not run"):
        evaluation.cell("free", "pf", 7)


def test_truth_by_frame(folder):
    evaluation = EvaluationFolder(folder)
    truth = evaluation.truth("bridge")
    assert list(truth) == list(range(1, FRAMES + 1))
    assert [n for n, t in truth.items() if t.occlusion.name == "TOTAL"] == list(range(9, 15))
    assert evaluation.truth("elsewhere") == {}


def test_labels_become_names_of_folders(tmp_path):
    assert safe_name("baseline:csrt") == "baseline_csrt"
    assert safe_name("apf@fast/2") == "apf_fast_2"
    assert cell_folder(tmp_path, "a", "baseline:x", 3) == tmp_path / "cells/a/baseline_x/seed-3"


@pytest.mark.parametrize(
    ("text", "sentence"),
    [(None, "is not an evaluation folder"), ('{"format": 1}', "another version"),
     ("{", "not JSON"), ("[]", "does not hold a JSON object"),
     ('{"recordings": []}', "broken: KeyError"), ('{"recordings": [{}]}', "broken")],
)  # fmt: skip
def test_mistakes_about_the_folder(tmp_path, text, sentence):
    if text is not None:
        (tmp_path / "evaluation.json").write_text(text)
    with pytest.raises(InputError, match=sentence):
        EvaluationFolder(tmp_path)


def test_a_document_that_is_not_there(tmp_path):
    with pytest.raises(InputError, match="cannot read"):
        read_document(tmp_path / "none.json")


def test_truth_comes_back_with_every_digit(tmp_path):
    truths = {
        3: Truth(1_700_000_000_123_456_789, Box(0.1 + 0.2, 1 / 3, 20.5, 7), Occlusion.PARTIAL),
        9: Truth(5, Box(-4.0, 2.0, 1.0, 1.0), Occlusion.TOTAL),
    }
    write_truth(tmp_path / "truth.csv", truths)
    assert read_truth(tmp_path / "truth.csv") == truths
    header, first, _ = (tmp_path / "truth.csv").read_text().splitlines()
    assert header == "frame,stamp_ns,x,y,width,height,occlusion"
    assert first.startswith("3,1700000000123456789,0.30000000000000004,")
    assert first.endswith(",partial")


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "must begin"),
        ("frame,x\n", "must begin"),
        ("frame,stamp_ns,x,y,width,height,occlusion\n1,5,1,1,1,1,half\n", "line 2 .* broken"),
        ("frame,stamp_ns,x,y,width,height,occlusion\n1,5,1,1\n", "line 2 .* broken"),
        ("frame,stamp_ns,x,y,width,height,occlusion\none,5,1,1,1,1,none\n", "line 2 .* broken"),
    ],
)
def test_mistakes_in_the_file(tmp_path, text, sentence):
    (tmp_path / "truth.csv").write_text(text)
    with pytest.raises(InputError, match=sentence):
        read_truth(tmp_path / "truth.csv")


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(InputError, match="cannot read the truth"):
        read_truth(tmp_path / "none.csv")
