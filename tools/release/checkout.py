# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The checkout that is to be tagged: committed, of one version, with its generated pages."""

from __future__ import annotations

import re
import sys
import xml.etree.ElementTree as ET
from collections.abc import Mapping
from pathlib import Path

from tools.release.commands import ReleaseError, run

STATED: Mapping[str, str] = {
    "CHANGELOG.rst": r"(?m)^(\d\S*)\n-+$",
    "CITATION.cff": r"(?m)^version: (\S+)$",
    "docs/performance.md": r"vehicle pf tracker ([\w.]+),",
}
"""Pattern of the version in each file that states it; the changelog's newest comes first."""


def version_of(root: Path) -> str:
    """Return the version of a checkout, which is that of its package.xml."""
    return ET.parse(root / "package.xml").getroot().findtext("version", "")  # noqa: S314 - our own


def check_clean(root: Path) -> str:
    """Check that git has all of the checkout; return the commit."""
    left = run("git", "status", "--porcelain", cwd=root).splitlines()
    if left:
        raise ReleaseError(f"the tree is not clean: {', '.join(line[3:] for line in left)}")
    return run("git", "rev-parse", "--short", "HEAD", cwd=root).strip()


def check_version(root: Path) -> str:
    """Check that all files state the version of package.xml, and that no tag has it; return it."""
    version = version_of(root)
    for name, pattern in STATED.items():
        named = re.search(pattern, (root / name).read_text(encoding="utf-8"))
        if named is None or named[1] != version:
            raise ReleaseError(f"{name} has {named[1] if named else 'no version'}, not {version}")
    if run("git", "tag", "--list", version, f"v{version}", cwd=root).strip():
        raise ReleaseError(f"the version {version} is tagged already")
    return version


def check_generated(root: Path) -> str:
    """Check that the pages and files that are generated are those of this code."""
    run(sys.executable, "-m", "tools.generate", cwd=root, PYTHONPATH=root)
    changed = run("git", "diff", "--name-only", cwd=root).split()
    if changed:
        raise ReleaseError(f"`make config` changes {', '.join(changed)}")
    return "generated pages are of this code"
