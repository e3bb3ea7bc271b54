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

import re
from pathlib import Path

import pytest

from vehicle_pf_tracker.cli.main import main
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.parameters.files import read_yaml
from vehicle_pf_tracker.trackers.registry import NODES, TRAFFIC, VARIANTS


def test_the_document_names_every_parameter_of_every_variant(capsys):
    assert main(["params", "all", "--markdown"]) == 0
    _, *sections = capsys.readouterr().out.split("\n## ")
    texts = {section.partition("\n")[0]: section for section in sections}
    assert list(texts) == ["Every node", "Several variants", *NODES]
    for name, variant in VARIANTS.items():
        for one, spec in Configuration.of(variant).specs().items():
            rows = [
                line
                for part in ("Every node", "Several variants", name)
                for line in texts[part].splitlines()
                if line.startswith(f"| `{one}` |")
                and (part != "Several variants" or f"`{name}`" in line.rpartition(" | ")[2])
            ]
            assert len(rows) == 1, (name, one)
            default = str(spec.default).lower() if spec.kind is bool else str(spec.default)
            assert f"| {default} |" in rows[0]
            assert spec.bounds_text in rows[0]
            assert spec.unit.replace("|", "\\|") in rows[0]
            assert spec.doc.replace("|", "\\|") in rows[0]


def test_the_document_says_how_traffic_differs_from_every_node(capsys):
    assert main(["params", "all", "--markdown"]) == 0
    _, every, *_, last = capsys.readouterr().out.split("\n## ")
    present = Configuration.of(TRAFFIC).specs()
    for name, spec in present.items():
        row = f"| `{name}` | {str(spec.default).lower() if spec.kind is bool else spec.default} |"
        assert (row in last) or (row in every), name
    lacking = set(re.findall(r"`([\w.]+)`", last.partition("\n\n|")[0]))
    assert lacking == set(re.findall(r"^\| `([\w.]+)`", every, re.M)) - set(present)


@pytest.mark.parametrize("name", NODES)
def test_the_printed_file_is_the_defaults(tmp_path, capsys, name):
    assert main(["params", name]) == 0
    path = tmp_path / "printed.yaml"
    path.write_text(capsys.readouterr().out)
    assert read_yaml(path, f"{name}_tracker") == Configuration.of(NODES[name]).to_mapping()


def test_path_is_that_of_the_installed_file(capsys):
    assert main(["params", "apf", "--path"]) == 0
    assert Path(capsys.readouterr().out.strip()).name == "apf.yaml"


def test_markdown_has_a_row_for_each_parameter(capsys):
    assert main(["params", "pf", "--markdown"]) == 0
    head, rule, *rows = capsys.readouterr().out.splitlines()
    assert len(rows) == len(Configuration.of(VARIANTS["pf"]).specs())
    assert rule == "| --- | --- | --- | --- | --- | --- | --- |"
    assert {line.count(" | ") for line in (head, rule, *rows)} == {6}
    assert any(row.startswith("| `sigma` | 8.0 | from 0.01 to 1000 | px/frame |") for row in rows)
