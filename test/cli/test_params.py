# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

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
