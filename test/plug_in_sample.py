# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The plug-in of docs/library.md, installed by pip."""

import re
import subprocess
import sys
from pathlib import Path

PAGE = Path(__file__).parents[1] / "docs" / "library.md"


def install(folder):
    """Install the page's `steady` without a network; return the folder for the path."""
    source = folder / "steady"
    source.mkdir()
    text = PAGE.read_text(encoding="utf-8").partition("## A variant of your own")[2]
    blocks = dict(re.findall(r"^```(toml|python)\n(.*?)^```", text, re.DOTALL | re.MULTILINE))
    (source / "pyproject.toml").write_text(blocks["toml"])
    (source / "steady_tracker.py").write_text(blocks["python"])
    words = ["--quiet", "--no-deps", "--no-index", "--no-build-isolation", "--target"]
    command = [sys.executable, "-m", "pip", "install", *words, str(folder / "site"), str(source)]
    subprocess.run(command, check=True)
    return folder / "site"
