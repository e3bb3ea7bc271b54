# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Files that follow from the registry and the parameter tables: `make config` writes them.

These are config/ (parameter files and the SROS 2 policy), docs/parameters.md, the picture of the
rooms in docs/images/rooms.svg, and the tables of variants between the markers in docs/choosing.md
and docs/variants.md.
"""

from __future__ import annotations

import sys
from pathlib import Path

from tools import ROOT, rooms
from tools.parameters_page import parameters_page
from tools.rooms_picture import picture
from tools.sros2_policy import policy
from tools.variant_tables import TABLES, markdown_table, replace_table
from vehicle_pf_tracker.cli.params import default_yaml
from vehicle_pf_tracker.ros.transport import LAUNCHED_SEGMENT, profile
from vehicle_pf_tracker.trackers.registry import NODES, VARIANTS


def generated_files(root: Path = ROOT) -> dict[Path, str]:
    """Return the text of every generated file; pages keep what stands outside the markers."""
    variants = VARIANTS.values()
    nodes = NODES.values()
    files = {root / "config" / f"{node.name}.yaml": default_yaml(node) for node in nodes}
    files[root / "config" / "sros2_policy.xml"] = policy(nodes)
    files[root / "config" / "large_images.xml"] = profile(LAUNCHED_SEGMENT)
    files[root / "docs" / "parameters.md"] = parameters_page()
    for page, columns in TABLES.items():
        text = (root / page).read_text(encoding="utf-8")
        files[root / page] = replace_table(text, markdown_table(columns, variants))
    graph = rooms.reduced(rooms.rooms_graph(root / rooms.PACKAGE))
    files[root / "docs" / "images" / "rooms.svg"] = picture(graph)
    return files


def main() -> int:
    """Write the files that are not up to date, and delete parameter files of no variant."""
    files = generated_files()
    for path in sorted((ROOT / "config").glob("*.yaml")):
        if path not in files:
            path.unlink()
            print(f"deleted {path.relative_to(ROOT)}")
    for path, text in files.items():
        if not path.is_file() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")
            print(f"wrote {path.relative_to(ROOT)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
