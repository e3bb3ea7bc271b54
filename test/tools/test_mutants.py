# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Mutation testing: which modules are changed, and what counts as noticed."""

import pytest

from tools import mutants


def test_every_room_has_modules_and_tests():
    for modules, tests in mutants.ROOMS.values():
        assert list((mutants.ROOT / "vehicle_pf_tracker").glob(modules))
        assert (mutants.ROOT / tests).exists()


@pytest.mark.parametrize(("verdicts", "status"), [((20, 1), 0), ((20, 2), 1)])
def test_too_many_survivors_are_a_failure(verdicts, status, monkeypatch, capsys):
    count, alive = verdicts
    outcome = mutants.Outcome(count, ["change"] * alive)
    monkeypatch.setattr(mutants, "survivors", lambda room, sample: outcome)
    assert mutants.main(["toy"]) == status
    assert f"toy: {count - alive} of {count} changes are noticed" in capsys.readouterr().out


def test_an_unknown_room_is_told():
    with pytest.raises(SystemExit, match="no room attic; choose some of filtering"):
        mutants.main(["attic"])


def test_survivors_are_shown_and_changes_that_no_test_reaches_count(monkeypatch, capsys):
    answers = {
        "run": "",
        "results": "    a.x_f__mutmut_1: killed\n    a.x_f__mutmut_2: survived\n"
        "    a.x_g__mutmut_1: no tests\n    a.x_g__mutmut_2: timeout\n"
        "    a.x_g__mutmut_3: not checked\n",
        "show": "-a\n+b",
    }
    monkeypatch.setattr(mutants, "COPIED", ("pyproject.toml",))
    outcome = mutants.survivors("toy", mutmut=lambda folder, *words: answers[words[0]])
    assert outcome == (4, ["a.x_f__mutmut_2", "a.x_g__mutmut_1"])
    assert capsys.readouterr().out == "-a\n+b\n-a\n+b\n"


def test_a_sample_is_of_the_changes_whose_numbers_end_so(monkeypatch):
    words = []
    monkeypatch.setattr(mutants, "COPIED", ("pyproject.toml",))
    outcome = mutants.survivors("toy", "37", lambda folder, *given: words.append(given) or "")
    assert outcome == (0, [])
    assert words[0][-2:] == ("*__mutmut_*3", "*__mutmut_*7")


def test_a_sample_of_no_digits_is_told():
    with pytest.raises(SystemExit, match="--sample x: name the last digits"):
        mutants.main(["toy", "--sample", "x"])
