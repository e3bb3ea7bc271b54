# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import json
from pathlib import Path

import pytest

from reproduction.__main__ import main
from reproduction.catalogue import PAPERS
from reproduction.experiment import PAPER_RULE, PRINTED_RULE
from reproduction.pages.page import PAGE, page_of_data
from reproduction.pages.page_text import page_text

DOCS = Path(__file__).parents[2] / "docs"

WORDS = ["--quick", "--seeds", "1", "--first-seed", "100", "--workers", "1"]


def reproduce(out, *words):
    return main([*words, *WORDS, "-o", str(out)])


def test_the_experiments_are_listed(capsys):
    assert main(["--list"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.partition(":")[0] for line in lines][:3] == ["apf-fig1", "apf-fig2", "apf-fig3"]


def test_one_experiment_writes_its_folder_and_its_section_of_the_page(tmp_path, capsys):
    out, docs = tmp_path / "out", tmp_path / "docs"
    assert reproduce(out, "apf-fig4", "--docs", str(docs)) == 0
    assert {path.name for path in (out / "apf-fig4").iterdir()} == {
        "data.csv", "figure.svg", "figure.png", "verdict.json", "verdict.md",
    }  # fmt: skip
    page = (docs / "reproduction.md").read_text()
    (picture,) = (docs / "images" / "reproduction").iterdir()
    assert f"(images/reproduction/{picture.name})" in page
    sizes = [(out / "apf-fig4" / f"figure.{kind}").stat().st_size for kind in ("svg", "png")]
    assert picture.stat().st_size == min(sizes)
    verdict = json.loads((out / "apf-fig4" / "verdict.json").read_text())
    assert "| 100 |" in page  # the seed
    assert f"apf-fig4: {verdict['holds']}  (" in capsys.readouterr().out
    section = page.partition("\n### apf-fig4")[2]
    overview = page.partition("\n## Claims")[2].partition("\n## Evidence")[0]
    assert f"`python -m reproduction apf-fig4 {' '.join(WORDS[:5])}`" in section
    for claim in verdict["claims"]:
        words = [finding["holds"] for finding in claim["findings"]]
        row = [claim["claim"], f"**{words[0]}**", *words[1:], "[apf-fig4](#apf-fig4)"]
        assert f"| {' | '.join(row)} |" in overview
        assert f"| **{claim['claim']}** ({claim['place']}) |  | *{claim['rule']}* |" in section
        for finding in claim["findings"]:
            assert f"| {' | '.join(finding.values())} |" in section


@pytest.mark.slow
def test_the_page_has_what_was_made_before_too_and_a_second_time_nothing_changes(tmp_path):
    out, docs = tmp_path / "out", tmp_path / "docs"
    reproduce(out, "apf-fig4")
    reproduce(out, "apf-fig2", "--docs", str(docs))
    page = (docs / "reproduction.md").read_text()
    assert (
        page.index("\n### Scharcanski")
        < page.index("\n### apf-fig2")
        < page.index("\n### apf-fig4")
    )
    assert "Khong" not in page  # nothing of it was made
    files = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    reproduce(out, "apf-fig2", "apf-fig4", "--docs", str(docs))
    assert {p: p.read_bytes() for p in tmp_path.rglob("*") if p.is_file()} == files


def test_the_page_of_the_documents_is_what_its_data_make():
    assert page_of_data(DOCS / "reproduction.json", PAPERS) == (DOCS / PAGE).read_text("utf-8")


def test_the_answer_counts_the_papers_own_claims():
    """Two of APF's hold in part, one of which we added."""
    claims = [
        {"claim": claim, "place": "V", "rule": "", "findings": [finding(holds), finding(printed)]}
        for claim, holds, printed in (
            ("it follows", "yes", "no"),
            ("it is fast", "partly", "yes"),
            ("(not a claim of the paper's) it is red", "partly", "no"),
        )
    ]
    for claim in claims:
        claim["findings"][1]["interpretation"] = PRINTED_RULE
    verdict = {
        "claims": claims,
        "seeds": [0],
        "holds": "partly",
        "under": {},
        "command": "",
        "remarks": [],
    }
    page = page_text(PAPERS, {"apf-fig2": verdict}, {"apf-fig2": "a.svg"}, "make", "")
    assert "Of 2 claims 1 hold here, 1 hold in\npart, and 0 do not." in page
    assert "| Scharcanski et al. 2011: APF | 2 | 1 | 1 | 0 | 1 of 2 |" in page


def finding(holds):
    return {"interpretation": PAPER_RULE, "holds": holds, "numbers": "1 px"}


def test_a_page_of_several_versions_of_the_code_is_refused(tmp_path, capsys):
    out, docs = tmp_path / "out", tmp_path / "docs"
    reproduce(out, "apf-fig2")
    of_older_code = out / "apf-table1" / "verdict.json"
    of_older_code.parent.mkdir()
    verdict = json.loads((out / "apf-fig2" / "verdict.json").read_text())
    of_older_code.write_text(json.dumps({**verdict, "code": "0"}))
    assert reproduce(out, "apf-fig2", "--docs", str(docs)) == 1
    assert "apf-table1 in " in capsys.readouterr().err
    assert not docs.exists()


@pytest.mark.parametrize(
    ("words", "status", "said"),
    [
        ([], 2, "--list"),
        (["apf-fig99"], 1, "'apf-fig99'"),
        (["apf-fig2", "--workers", "0"], 2, "'0' is not an integer >= 1"),
        (["apf-fig2", "--seeds", "two"], 2, "'two' is not an integer >= 1"),
        (["apf-fig2", "--first-seed", "-1"], 2, "first-seed"),
    ],
)
def test_mistakes_are_told(words, status, said, capsys, tmp_path):
    assert main([*words, "-o", str(tmp_path)]) == status
    assert said in capsys.readouterr().err


def test_an_output_that_is_a_file_is_told(tmp_path, capsys):
    (tmp_path / "out").write_text("")
    assert reproduce(tmp_path / "out", "apf-fig2") == 1
    assert "is a file" in capsys.readouterr().err
