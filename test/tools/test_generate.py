# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The files that `make config` writes are up to date."""

import pytest

from tools import ROOT, generate
from tools.generate import generated_files

FILES = generated_files(ROOT)


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_a_generated_file_is_up_to_date(path):
    # `make config` writes it anew.
    assert path.read_text(encoding="utf-8") == FILES[path]


def test_config_has_no_file_too_many():
    assert set((ROOT / "config").iterdir()) == {
        path for path in FILES if path.parent.name == "config"
    }


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
