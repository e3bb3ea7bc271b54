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
