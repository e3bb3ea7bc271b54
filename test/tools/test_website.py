# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Pages of the site that are made of something else."""

import re

from tools.website import ROOT, changes, commands, first_page, on_page_markdown, python_interface
from vehicle_pf_tracker.cli.main import VERBS


def test_the_first_page_links_to_what_the_readme_links_to():
    links = re.findall(r"\]\((?!https?:|#)([^)#]+)", first_page())
    assert "first_steps.md" in links
    for link in links:
        assert (ROOT / "docs" / link).exists(), link


def test_files_outside_of_the_site_are_named_instead_of_linked_to():
    text = on_page_markdown("see [the licence](../LICENSE) and [roads](road.md)")
    assert text == "see the licence (`LICENSE` in the repository) and [roads](road.md)"


def test_reference_pages_have_every_verb_name_and_version():
    page = commands()
    for verb in VERBS:
        assert f"## {verb}\n\n```text\nusage: vehicle-pf-tracker {verb}" in page
    assert "::: vehicle_pf_tracker.trackers.registry.make_tracker\n" in python_interface()
    assert re.findall(r"^## (\S+)$", changes(), re.MULTILINE) == ["1.0.0"]
