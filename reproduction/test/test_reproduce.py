# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import json

import pytest

from reproduction.__main__ import main

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
    assert "| claim | the paper's rule | our interpretation | as printed | verdict |" in section
    assert f"`python -m reproduction apf-fig4 {' '.join(WORDS[:5])}`" in section
    for claim in verdict["claims"]:
        cells = [f"**{f['holds']}**: {f['numbers']}" for f in claim["findings"]]
        row = [f"{claim['claim']} ({claim['place']})", *cells, claim["rule"]]
        assert f"| {' | '.join(row)} |" in section


@pytest.mark.slow
def test_the_page_has_what_was_made_before_too_and_a_second_time_nothing_changes(tmp_path):
    out, docs = tmp_path / "out", tmp_path / "docs"
    reproduce(out, "apf-fig4")
    reproduce(out, "apf-fig2", "--docs", str(docs))
    page = (docs / "reproduction.md").read_text()
    assert (
        page.index("\n## Scharcanski") < page.index("\n### apf-fig2") < page.index("\n### apf-fig4")
    )
    assert "Khong" not in page  # nothing of it was made
    assert (
        "| claim | result | verdict |" in page.partition("\n### apf-fig2")[2]
    )  # no interpretations
    files = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    reproduce(out, "apf-fig2", "apf-fig4", "--docs", str(docs))
    assert {p: p.read_bytes() for p in tmp_path.rglob("*") if p.is_file()} == files


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
