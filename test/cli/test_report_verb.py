# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

from vehicle_pf_tracker.cli.main import main


def test_a_folder_that_holds_no_evaluation(tmp_path, capsys):
    assert main(["report", str(tmp_path)]) == 1
    assert "is not an evaluation folder: it has no evaluation.json" in capsys.readouterr().err


def test_the_verb_writes_where_the_evaluation_is(tmp_path, capsys):
    (tmp_path / "evaluation.json").write_text('{"recordings": [], "systems": [], "seeds": []}')
    assert main(["report", str(tmp_path)]) == 0
    assert capsys.readouterr().out == f"the report is {tmp_path / 'report.html'}\n"
    assert (tmp_path / "report.html").stat().st_size > 1000
