# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Licences of the distributions in an environment, as their metadata state them."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

from tools.release.commands import ReleaseError, run

_OF_ROS = re.compile(r"ros-|ros(idl|graph)_|r(cl|cutils|mw)|std_srvs$|.*_(msgs|interfaces)$")
"""Names of ROS 2's wheels, which say nothing of their licences (Apache-2.0 and BSD)."""
_ASK = """
import re
from importlib.metadata import distributions
for package in distributions():
    facts = package.metadata
    classes = [c.rpartition("::")[2] for c in facts.get_all("Classifier", []) if "License" in c]
    words = facts.get("License-Expression") or "; ".join(classes) or facts.get("License") or ""
    files = [f for f in package.files or [] if re.search("(?i)licen[sc]e|copying|notice", f.name)]
    print(facts["Name"], facts["Version"], " ".join(words.split())[:60], len(files), sep="\\t")
"""
"""Program that the environment's own Python runs: it has only what was installed there."""


class Licence(NamedTuple):
    """Licence of an installed distribution, with the number of its files."""

    name: str
    version: str
    words: str
    files: int


def licences_in(python: Path) -> list[Licence]:
    """Return the licences of all distributions in the environment of a Python."""
    lines = run(python, "-c", _ASK, cwd=python.parent).splitlines()
    rows = [line.split("\t") for line in lines]
    return sorted(Licence(name, version, words, int(files)) for name, version, words, files in rows)


def check_licences(licences: Iterable[Licence]) -> str:
    """Check that every distribution but ROS 2's states its licence, in words or by a file."""
    stated = []
    silent = []
    for licence in licences:
        if licence.words or licence.files:
            stated.append(licence)
        elif not _OF_ROS.match(licence.name):
            silent.append(licence.name)
    if silent:
        raise ReleaseError(f"these state no licence: {', '.join(silent)}")
    return "; ".join(
        f"{licence.name} {licence.version}: {licence.words or 'see its file'}" for licence in stated
    )
