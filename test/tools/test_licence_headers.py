# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import pytest

from tools.licence_headers import HEADER, with_header, without_header


def test_every_file_has_the_licences_header():
    assert list(without_header()) == []  # `python -m tools.licence_headers` adds it


def test_a_file_without_it_is_found(tmp_path):
    folder = tmp_path / "test"
    folder.mkdir()
    (folder / "empty.py").write_text("")
    (folder / "good.py").write_text(HEADER + '"""Text."""\n')
    (folder / "bad.py").write_text('"""Text."""\n')
    assert [path.name for path in without_header(tmp_path)] == ["bad.py"]


@pytest.mark.parametrize("text", ["x = 1\n", HEADER + "x = 1\n", HEADER.rstrip("\n") + "\nx = 1\n"])
def test_the_header_is_added_once(text):
    assert with_header(text) == HEADER + "x = 1\n"
