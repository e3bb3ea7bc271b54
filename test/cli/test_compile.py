# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`compile` without what it compiles."""

import sys

from vehicle_pf_tracker.cli.main import main


def test_without_numba_the_extra_is_named(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "numba", None)
    for name in [one for one in sys.modules if one.startswith("vehicle_pf_tracker.image.kernels.")]:
        monkeypatch.delitem(sys.modules, name)
    assert main(["compile"]) == 1
    err = capsys.readouterr().err
    assert "pip install 'vehicle_pf_tracker[numba]'" in err
    assert err.count("\n") == 1
