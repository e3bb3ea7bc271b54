# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import json

import pytest

from reproduction import experiment as ex
from reproduction.numbers import (
    counted,
    mean_and_spread,
    median_and_range,
    rank_correlation,
    share,
)

YES, PARTLY, NO = ex.Holds.YES, ex.Holds.PARTLY, ex.Holds.NO


@pytest.mark.parametrize(
    ("parts", "joined"),
    [([YES, YES], YES), ([NO, NO], NO), ([YES, NO], PARTLY), ([PARTLY], PARTLY),
     ([YES, PARTLY], PARTLY), ([NO, PARTLY], PARTLY)],
)  # fmt: skip
def test_claims_are_joined(parts, joined):
    assert ex.Holds.all(parts) is joined


@pytest.mark.parametrize(("value", "holds"), [(1, YES), (0.95, YES), (0.5, PARTLY), (0.49, NO)])
def test_shares_are_judged(value, holds):
    assert ex.Holds.share(value) is holds


def verdict():
    findings = ex.Finding("our interpretation", YES, "3 px"), ex.Finding("as printed", NO, "300 px")
    return ex.ExperimentVerdict(
        (ex.Claim("it follows", "figure 1", findings, "yes: 5 px"),), "A bar.", ("Mind the gap.",)
    )


def test_the_first_finding_decides():
    assert verdict().holds is YES


def test_claims_are_joined_under_each_interpretation():
    claims = (
        ex.Claim(
            "one",
            "figure 1",
            (ex.Finding(ex.PAPER_RULE, YES, ""), ex.Finding(ex.PRINTED_RULE, NO, "")),
            "",
        ),
        ex.Claim("two", "figure 1", (ex.Finding("their defaults", NO, ""),), ""),
    )
    found = ex.ExperimentVerdict(claims, "")
    assert found.holds is PARTLY
    assert found.under(ex.PRINTED_RULE) is NO
    assert found.under(ex.OUR_INTERPRETATION) is None
    assert found.to_json()["under"] == {
        ex.BASIC_RIVALS: None,
        ex.OUR_INTERPRETATION: None,
        ex.PRINTED_RULE: "no",
    }


def test_a_verdict_is_plain_json():
    document = json.loads(json.dumps(verdict().to_json()))
    assert document["holds"] == "yes"
    assert document["claims"][0]["findings"][1] == {
        "interpretation": "as printed", "holds": "no", "numbers": "300 px",
    }  # fmt: skip


def test_a_verdict_is_a_text_with_a_table_for_each_claim():
    assert verdict().to_markdown() == (
        "**Verdict: yes.**\n\nA bar.\n\nClaim (figure 1): it follows. Judged: "
        "yes: 5 px; no otherwise.\n\n"
        "| interpretation | holds | result |\n|---|---|---|\n"
        "| our interpretation | **yes** | 3 px |\n| as printed | **no** | 300 px |\n\nMind the "
        "gap.\n"
    )


def test_tables_keep_every_digit_for_programs_and_few_for_the_eye():
    table = ex.DataTable(("name", "px"), (("a", 1 / 3), ("b", None)))
    assert table.to_csv() == "name,px\na,0.3333333333333333\nb,\n"
    assert table.to_markdown() == "| name | px |\n| --- | ---: |\n| a | 0.3 |\n| b | – |\n"


def test_numbers_are_told_with_their_spread():
    assert median_and_range([1.0, 9.0, 2.0]) == "2.0 (1.0 to 9.0)"
    assert mean_and_spread([1.0, 3.0]) == "2.0 ± 1.4"
    assert mean_and_spread([1.0]) == "1.0 ± 0.0"
    assert counted([True, False, True]) == "2 of 3"
    assert (share([True, False]), share([])) == (0.5, 0.0)


def test_rank_correlation_by_hand():
    assert rank_correlation([1, 2, 3], [10, 100, 1000]) == pytest.approx(1)
    assert rank_correlation([1, 2, 3], [3, 2, 1]) == pytest.approx(-1)
    # Ranks 1 2 3 4 and 1.5 1.5 3 4: covariance 4.5, squares 5 and 4.5.
    assert rank_correlation([1, 2, 3, 4], [5, 5, 6, 7]) == pytest.approx(4.5 / (5 * 4.5) ** 0.5)
    assert rank_correlation([1, 2, 3], [7, 7, 7]) == 0
