# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import os

import pytest

from tools.release.commands import ReleaseError, run


def test_a_command_is_run_without_what_the_shell_has_sourced(monkeypatch, tmp_path):
    monkeypatch.setenv("PYTHONPATH", "here")
    monkeypatch.setenv("KEPT", "1")
    script = 'echo "$PWD $PYTHONPATH $KEPT $GIVEN"'
    assert run("sh", "-c", script, cwd=tmp_path, GIVEN=2) == f"{os.path.realpath(tmp_path)}  1 2\n"


def test_one_that_fails_is_told_with_all_that_it_printed(tmp_path):
    with pytest.raises(ReleaseError, match=r"`sh -c .*` ends with 3:\nsaid\nwarned\n"):
        run("sh", "-c", "echo said; echo warned >&2; exit 3", cwd=tmp_path)
