# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The files that `make config` writes are up to date, and their tables go where the markers are."""

from pathlib import Path

import pytest

from tools import generate
from tools.generate import BEGIN, END, generated_files, markdown_table, replace_table
from vehicle_pf_tracker.trackers.registry import VARIANTS

ROOT = Path(__file__).resolve().parents[2]
FILES = generated_files(ROOT)


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_a_generated_file_is_up_to_date(path):
    # `make config` writes it anew.
    assert path.read_text(encoding="utf-8") == FILES[path]


def test_config_has_no_file_too_many():
    assert set((ROOT / "config").iterdir()) == {
        path for path in FILES if path.parent.name == "config"
    }


def test_a_table_has_a_row_for_each_variant():
    columns = {"name": lambda one: one.name, "node": lambda one: one.executable}
    pair = [VARIANTS["pf"], VARIANTS["ms"]]
    assert markdown_table(columns, pair).splitlines() == [
        "| name | node |",
        "| --- | --- |",
        "| pf | pf_tracker |",
        "| ms | ms_tracker |",
    ]


def test_a_page_keeps_what_is_around_its_table():
    page = f"before\n{BEGIN}old\n{END}\nafter\n"
    assert replace_table(page, "new\n") == f"before\n{BEGIN}new\n{END}\nafter\n"


@pytest.mark.parametrize("page", ["", BEGIN, END, END + BEGIN])
def test_a_page_without_markers_is_an_error(page):
    with pytest.raises(ValueError, match="no pair of markers"):
        replace_table(page, "new\n")


def test_only_changes_are_written_and_left_over_files_deleted(monkeypatch, tmp_path, capsys):
    config = tmp_path / "config"
    config.mkdir()
    files = {config / "a.yaml": "a", config / "b.yaml": "b"}
    monkeypatch.setattr(generate, "ROOT", tmp_path)
    monkeypatch.setattr(generate, "generated_files", lambda: files)
    (config / "a.yaml").write_text("a")
    (config / "b.yaml").write_text("old")
    (config / "gone.yaml").write_text("")
    assert generate.main() == 0
    assert capsys.readouterr().out == "deleted config/gone.yaml\nwrote config/b.yaml\n"
    assert {path: path.read_text() for path in config.iterdir()} == files
