# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import re

from tools.parameters_page import parameters_page
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.trackers.registry import NODES, TRAFFIC_VARIANT, VARIANTS


def test_the_document_names_every_parameter_of_every_variant():
    _, *sections = parameters_page().split("\n## ")
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


def test_the_document_says_how_traffic_differs_from_every_node():
    _, every, *_, last = parameters_page().split("\n## ")
    present = Configuration.of(TRAFFIC_VARIANT).specs()
    for name, spec in present.items():
        row = f"| `{name}` | {str(spec.default).lower() if spec.kind is bool else spec.default} |"
        assert (row in last) or (row in every), name
    lacking = set(re.findall(r"`([\w.]+)`", last.partition("\n\n|")[0]))
    assert lacking == set(re.findall(r"^\| `([\w.]+)`", every, re.M)) - set(present)
