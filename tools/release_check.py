# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The checks before a release is tagged, in their order: of the checkout, then of its archives.

    python -m tools.release_check results/dist [--extras video ros evaluation] [--pythons 3.10 3.13]

`make release-check` builds the archives first. Every check runs, also after one that failed; the
status says whether all held. Each kind of check is a module of `tools.release`.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Collection, Iterator
from functools import partial
from itertools import product
from pathlib import Path
from typing import NamedTuple

from tools import ROOT
from tools.release import checkout
from tools.release.archives import Archives, check_archives
from tools.release.commands import ReleaseError
from tools.release.installation import check_installation
from tools.release.journeys import WRITTEN


class Check(NamedTuple):
    """Check that can be run: it returns what it found, or raises `ReleaseError`."""

    name: str
    run: Callable[[], str]


def checks(
    dist: Path, extras: Collection[str], versions: Collection[str | None] = (None,)
) -> Iterator[Check]:
    """Give the checks in their order.

    Parameters
    ----------
    dist : Path
        Folder of the archives.
    extras : collection of str
        Extras with which the wheel is installed.
    versions : collection of str or None
        Versions of Python that install it, as `3.12`; None is that of this process.
    """
    # 1. The checkout.
    yield Check("clean tree", partial(checkout.check_clean, ROOT))
    yield Check("version", partial(checkout.check_version, ROOT))
    yield Check("pages", partial(checkout.check_generated, ROOT))
    # 2. The archives as files.
    archives = Archives.of(dist, checkout.version_of(ROOT))
    yield Check("archives", partial(check_archives, archives))
    # 3. The wheel, installed by every Python with every extra.
    for version, extra in product(versions, extras):
        name = f"wheel [{extra}]" + (f" with Python {version}" if version else "")
        yield Check(name, partial(check_installation, archives.wheel, extra, version))
    # 4. The source archive once: what it builds is the same wheel.
    if "video" in extras:
        yield Check("source [video]", partial(check_installation, archives.source, "video"))


def main(words: list[str] | None = None) -> int:
    """Run the checks that a command line asks for, and return its status."""
    parser = argparse.ArgumentParser(
        prog="python -m tools.release_check", description=(__doc__ or "").partition("\n")[0]
    )
    parser.add_argument("dist", type=Path, help="folder of the archives, as `make dist` fills it")
    parser.add_argument("--extras", nargs="*", default=list(WRITTEN), choices=WRITTEN)
    parser.add_argument("--pythons", nargs="+", default=[None], help="versions, as 3.12, on PATH")
    args = parser.parse_args(words)
    verdicts = [_holds(check) for check in checks(args.dist, args.extras, args.pythons)]
    return int(not all(verdicts))


def _holds(check: Check) -> bool:
    """Print what a check found, or why it failed, and return whether it holds."""
    try:
        print(f"{check.name}: ok, {check.run()}", flush=True)
    except ReleaseError as problem:
        print(f"{check.name}: FAILED: {problem}", flush=True)
        return False
    return True


if __name__ == "__main__":
    sys.exit(main())
