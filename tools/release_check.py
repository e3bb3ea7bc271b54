# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Checks before a release is tagged: the checkout, and its archives in fresh environments.

    python -m tools.release_check results/dist [--extras video ros evaluation] [--pythons 3.10 3.13]

`make release-check` builds the archives first. Every check runs; the status says whether all held.
In each environment the README's way is gone and judged (`tools.journeys`), with no more than the
extra that it names.
"""

from __future__ import annotations

import argparse
import os
import re
import subprocess
import sys
import tarfile
import xml.etree.ElementTree as ET
import zipfile
from collections.abc import Callable, Collection, Iterable, Iterator
from functools import partial
from itertools import product
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from tools import journeys
from tools.journeys import ROOT, WRITTEN

NAME = "vehicle_pf_tracker"
SIZES = {"video": 690, "ros": 760, "evaluation": 830}
"""Largest site-packages by extra, MB: a twentieth above docs/development.md, so that what a new
release of a library adds is noticed."""
_PAGES_WITH_VERSION = ("docs/performance.md",)
_OF_ROS = re.compile(r"ros-|ros(idl|graph)_|r(cl|cutils|mw)|std_srvs$|.*_(msgs|interfaces)$")
"""Names of ROS 2's wheels, which say nothing of their licences (Apache-2.0 and BSD)."""
_ASK_LICENCES = """
import re
from importlib.metadata import distributions
for package in distributions():
    facts = package.metadata
    classes = [c.rpartition("::")[2] for c in facts.get_all("Classifier", []) if "License" in c]
    words = facts.get("License-Expression") or "; ".join(classes) or facts.get("License") or ""
    files = [f for f in package.files or [] if re.search("(?i)licen[sc]e|copying|notice", f.name)]
    print(facts["Name"], facts["Version"], " ".join(words.split())[:60], len(files), sep="\\t")
"""


class ReleaseError(Exception):
    """Reason against a release, one sentence."""


class Licence(NamedTuple):
    """Licence of an installed distribution, with the number of its files."""

    name: str
    version: str
    words: str
    files: int


def run(*command: object, cwd: Path, **variables: object) -> str:
    """Run a command away from the checkout and any ROS workspace, and return what it prints.

    Raises
    ------
    ReleaseError
        If it fails.
    """
    hidden = {"AMENT_PREFIX_PATH", "COLCON_PREFIX_PATH", "PYTHONPATH", "PYTHONUSERBASE", "COLCON"}
    environment = {name: value for name, value in os.environ.items() if name not in hidden}
    environment.update({name: str(value) for name, value in variables.items()})
    words = list(map(str, command))
    done = subprocess.run(
        words, cwd=cwd, env=environment, text=True, capture_output=True, check=False
    )
    if done.returncode:
        raise ReleaseError(
            f"`{' '.join(words)}` ends with {done.returncode}:\n{done.stdout}{done.stderr}"
        )
    return done.stdout


def check_clean(root: Path) -> str:
    """Check that git has all of the checkout."""
    left = run("git", "status", "--porcelain", cwd=root).splitlines()
    if left:
        raise ReleaseError(f"the tree is not clean: {', '.join(line[3:] for line in left)}")
    return run("git", "rev-parse", "--short", "HEAD", cwd=root).strip()


def check_version(root: Path) -> str:
    """Check that all files state the version of package.xml, and that no tag has it."""
    version = ET.parse(root / "package.xml").getroot().findtext("version", "")  # noqa: S314
    stated = {
        "CHANGELOG.rst": r"(?m)^(\d\S*)\n-+$",
        "CITATION.cff": r"(?m)^version: (\S+)$",
        **dict.fromkeys(_PAGES_WITH_VERSION, r"vehicle pf tracker ([\w.]+),"),
    }
    for name, pattern in stated.items():
        named = re.search(pattern, (root / name).read_text(encoding="utf-8"))
        if named is None or named[1] != version:
            raise ReleaseError(f"{name} has {named[1] if named else 'no version'}, not {version}")
    if run("git", "tag", "--list", version, f"v{version}", cwd=root).strip():
        raise ReleaseError(f"the version {version} is tagged already")
    return version


def check_pages(root: Path) -> str:
    """Check that the pages and files that are generated are those of this code."""
    run(sys.executable, "-m", "tools.generate", cwd=root, PYTHONPATH=root)
    changed = run("git", "diff", "--name-only", cwd=root).split()
    if changed:
        raise ReleaseError(f"`make config` changes {', '.join(changed)}")
    return "generated pages are of this code"


def archives(folder: Path, version: str) -> tuple[Path, Path]:
    """Return the wheel and the source archive of a version, with its licence in them."""
    wheel = folder / f"{NAME}-{version}-py3-none-any.whl"
    source = folder / f"{NAME}-{version}.tar.gz"
    for path in (wheel, source):
        if not path.exists():
            raise ReleaseError(f"{path} is not there: `make dist`")
    with zipfile.ZipFile(wheel) as of_wheel, tarfile.open(source) as of_source:
        names = {wheel: of_wheel.namelist(), source: of_source.getnames()}
    for path, inside in names.items():
        if not any(re.search(r"(^|/)LICENSE$", name) for name in inside):
            raise ReleaseError(f"{path.name} has no LICENSE")
    return wheel, source


def interpreter(version: str | None) -> Path:
    """Return the interpreter of a version, as `3.12`, on PATH; None is that of this process."""
    if version is None:
        return Path(sys.executable)
    return Path(run(ROOT / ".ci" / "find-python", version, cwd=ROOT).strip())


def installed(archive: Path, extra: str, folder: Path, version: str | None = None) -> Path:
    """Install an archive with an extra into a fresh environment, and return its Python."""
    run(interpreter(version), "-m", "venv", "--symlinks", "--without-pip", folder, cwd=ROOT)
    python = folder / "bin" / "python"
    pip = (sys.executable, "-m", "pip", "--python", python, "--disable-pip-version-check")
    run(*pip, "install", "--quiet", f"{archive.absolute()}[{extra}]", cwd=folder)
    return python


def licences_in(python: Path) -> list[Licence]:
    """Return the licences of all distributions in an environment."""
    lines = run(python, "-c", _ASK_LICENCES, cwd=python.parent).splitlines()
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


def megabytes(python: Path) -> int:
    """Return the size of the site-packages beside a Python, MB, as `du -sm` has it."""
    (folder,) = python.parents[1].glob("lib/python*/site-packages")
    return int(run("du", "-sm", folder, cwd=folder).split()[0])


def check_install(archive: Path, extra: str, version: str | None = None) -> str:
    """Check an archive in a fresh environment: README, licences; return them and its size."""
    with TemporaryDirectory(prefix="release-check-") as scratch:
        python = installed(archive, extra, Path(scratch, "env"), version)
        size = megabytes(python)
        stated = check_licences(licences_in(python))
        follow(python, extra, Path(scratch, "work"))
    if size > SIZES[extra]:
        raise ReleaseError(f"[{extra}] takes {size} MB, more than {SIZES[extra]}")
    return f"{size} MB; {stated}"


def follow(python: Path, extra: str, folder: Path) -> None:
    """Type the commands of a way in an empty folder, and judge what they leave."""
    folder.mkdir(exist_ok=True)
    script = f"trap 'kill $(jobs -p) || true' EXIT\nset -e\n{journeys.commands(extra)}"
    variables = {
        "PATH": f"{python.parent}:{os.environ['PATH']}",
        "ROS_DOMAIN_ID": 1 + os.getpid() % 100,  # not that of nodes beside this one
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
    }
    run("bash", "-c", script, cwd=folder, **variables)
    if problem := journeys.problem(extra, folder):
        raise ReleaseError(f"the README's commands for [{extra}]: {problem}")


def checks(
    dist: Path, extras: Collection[str], versions: Collection[str | None] = (None,)
) -> Iterator[tuple[str, Callable[[], object]]]:
    """Give the checks by name, in their order."""
    yield "clean tree", lambda: check_clean(ROOT)
    yield "version", lambda: check_version(ROOT)
    yield "pages", lambda: check_pages(ROOT)
    version = ET.parse(ROOT / "package.xml").getroot().findtext("version", "")  # noqa: S314
    yield "archives", lambda: ", ".join(path.name for path in archives(dist, version))
    for python, extra in product(versions, extras):
        name = f"wheel [{extra}]" + (f" with Python {python}" if python else "")
        yield name, partial(_check_archive, 0, dist, version, extra, python)
    if "video" in extras:
        yield "source [video]", partial(_check_archive, 1, dist, version, "video", None)


def _check_archive(which: int, dist: Path, version: str, extra: str, python: str | None) -> str:
    return check_install(archives(dist, version)[which], extra, python)


def main(words: list[str] | None = None) -> int:
    """Run the checks that a command line asks for, and return its status."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("dist", type=Path, help="folder of the archives, as `make dist` fills it")
    parser.add_argument("--extras", nargs="*", default=list(WRITTEN), choices=WRITTEN)
    parser.add_argument("--pythons", nargs="+", default=[None], help="versions, as 3.12, on PATH")
    args = parser.parse_args(words)
    verdicts = [_holds(name, check) for name, check in checks(args.dist, args.extras, args.pythons)]
    return int(not all(verdicts))


def _holds(name: str, check: Callable[[], object]) -> bool:
    """Print whether a check holds, and return that."""
    try:
        print(f"{name}: ok, {check()}", flush=True)
    except ReleaseError as problem:
        print(f"{name}: FAILED: {problem}", flush=True)
        return False
    return True


if __name__ == "__main__":
    sys.exit(main())
