# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import pytest

from vehicle_pf_tracker.cli.main import main
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.parameters.files import read_yaml
from vehicle_pf_tracker.trackers.registry import NODES


@pytest.mark.parametrize("name", NODES)
def test_the_printed_file_is_the_defaults(tmp_path, capsys, name):
    assert main(["params", name]) == 0
    path = tmp_path / "printed.yaml"
    path.write_text(capsys.readouterr().out)
    assert read_yaml(path, f"{name}_tracker") == Configuration.of(NODES[name]).to_mapping()
