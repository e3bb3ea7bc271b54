# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import pytest

from vehicle_pf_tracker.cli.main import main


def test_a_folder_that_holds_no_evaluation(tmp_path, capsys):
    assert main(["report", str(tmp_path)]) == 1
    assert "is not an evaluation folder: it has no evaluation.json" in capsys.readouterr().err


def test_the_verb_writes_where_the_evaluation_is(tmp_path, capsys):
    (tmp_path / "evaluation.json").write_text('{"recordings": [], "systems": [], "seeds": []}')
    assert main(["report", str(tmp_path)]) == 0
    assert capsys.readouterr().out == f"the report is {tmp_path / 'report.html'}\n"
    assert (tmp_path / "report.html").stat().st_size > 1000


@pytest.mark.parametrize("broken", ["make_page", "summary_csv", "write_figures"])
def test_a_part_of_the_report_that_fails_costs_itself_alone(tmp_path, monkeypatch, capsys, broken):
    def fail(*_, **__):
        raise RuntimeError("it fails")

    (tmp_path / "evaluation.json").write_text('{"recordings": [], "systems": [], "seeds": []}')
    monkeypatch.setattr(f"vehicle_pf_tracker.evaluation.report.writing.{broken}", fail)
    assert main(["report", str(tmp_path), "--figures", "png"]) == 1
    err = capsys.readouterr().err
    assert err.count("it fails; all else is written") == 1 and "Traceback" not in err
    assert (tmp_path / "report.html").exists() == (broken != "make_page")
    assert (tmp_path / "summary.csv").exists() == (broken != "summary_csv")
    assert (tmp_path / "summary.json").exists()
