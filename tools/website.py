# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The pages of the site that are made of something else, for mkdocs (`make docs`).

The README is the first page; the commands are those of the parser, the Python interface that of the
package's public names, and the changes those of CHANGELOG.rst.
"""

from __future__ import annotations

import contextlib
import io
import os
import re
from typing import Any
from unittest import mock

import vehicle_pf_tracker
from tools import ROOT
from vehicle_pf_tracker.cli.console import PROGRAM_NAME
from vehicle_pf_tracker.cli.main import VERBS, main

OUTSIDE = re.compile(r"\[([^\]]*)\]\(\.\./([^)]*)\)")
"""A link from a page to a file of the repository that the site does not have."""


def on_files(files: Any, config: Any) -> Any:
    """Add the pages and the script that are not in docs/."""
    from mkdocs.structure.files import File  # noqa: PLC0415 - with `make docs` only

    pages = {
        "index.md": first_page,
        "commands.md": commands,
        "python.md": python_interface,
        "changes.md": changes,
    }
    for name, write in pages.items():
        files.append(File.generated(config, name, content=write()))
    # Search of a page that was opened as a file, where browsers refuse workers.
    shim = (ROOT / "tools" / "iframe-worker.js").read_text(encoding="utf-8")
    files.append(File.generated(config, "assets/iframe-worker.js", content=shim))
    return files


def on_page_markdown(markdown: str, **_: Any) -> str:
    """Name files of the repository instead of linking to them."""
    return OUTSIDE.sub(r"\1 (`\2` in the repository)", markdown)


def first_page() -> str:
    """Return the README with its links as seen from docs/."""
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    return re.sub(r"\]\((?!https?:|#|docs/)", "](../", text).replace("](docs/", "](")


def commands() -> str:
    """Return what every verb says with ``--help``."""
    wide = mock.patch.dict(os.environ, COLUMNS="100")
    parts = ["# Commands", f"What `{PROGRAM_NAME} VERB --help` prints."]
    for verb in VERBS:
        with wide, contextlib.redirect_stdout(io.StringIO()) as printed:
            main([verb, "--help"])
        parts += [f"## {verb}", f"```text\n{printed.getvalue().strip()}\n```"]
    return "\n\n".join(parts) + "\n"


def python_interface() -> str:
    """Return the public names, for mkdocstrings to describe."""
    objects = [getattr(vehicle_pf_tracker, name) for name in vehicle_pf_tracker.__all__]
    names = (f"::: {public.__module__}.{public.__name__}\n" for public in objects)
    return "\n".join(["# Python\n\nWhat `import vehicle_pf_tracker` has.\n", *names])


def changes() -> str:
    """Return CHANGELOG.rst as Markdown: its headings, lists and code are all that it uses."""
    text = (ROOT / "CHANGELOG.rst").read_text(encoding="utf-8").split("\n\n", 1)[1]
    headed = re.sub(r"^(\S.*)\n-{3,}$", r"## \1", text, flags=re.MULTILINE)
    return "# Changes\n\n" + headed.replace("``", "`")
