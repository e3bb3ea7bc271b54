# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Write the lock files anew: `python requirements/lock.py python3.10 python3.11 python3.12 ...`.

`--only NAME` before the interpreters writes that lock alone (docs and mutants need none);
`--hashes` and no interpreters keep all versions and write the hashes anew.

For every interpreter and every lock file, pip resolves the extras of setup.py in a throw-away
environment. A version that all interpreters share is written once; where they differ, each line
carries a marker. Each pin has the hashes of every file of that version, so that a lock made on one
platform serves the others. Give all supported interpreters, and run it on Linux x86_64.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent

SETUPTOOLS = "setuptools>=77,<80"  # builds this package; the upper limit is colcon's
BASE = (SETUPTOOLS, f"{ROOT}[dev]")
EXAMPLES = ("supervision>=0.26",)  # what docs/examples.md shows, run by tests
ROS = (*BASE, f"{ROOT}[ros]")
KILTED = (*BASE, "ros-kilted-rclpy[fastrtps]==9.1.2", "ros-kilted-common-interfaces==5.5.1")
COLCON = (
    *BASE,
    "colcon-bash",
    "colcon-output",
    "colcon-package-information",
    "colcon-package-selection",
    "colcon-parallel-executor",
    "colcon-ros",
    "colcon-test-result",
)
BESIDE = {  # installed beside locked.txt by the targets that need them
    "docs": ("mkdocs-material", "mkdocstrings[python]", "build", "twine"),
    "mutants": ("mutmut>=3.8",),
}
NOBLE = (  # what Ubuntu 24.04 has from apt; its Python is 3.12
    SETUPTOOLS,
    f"{ROOT}[test]",
    "matplotlib",
    "scipy",
    "jinja2",
    "numpy==1.26.4",
    "opencv-python-headless==4.6.0.66",
    "PyYAML==6.0.1",
    "rich==13.7.1",
    "pytest==7.4.4",
)
BASELINES = (  # the trackers compared with, and the scores of many vehicles
    "opencv-contrib-python-headless<5",
    "trackers==2.6.1",
    "trackeval==1.3.0",
)
# Asked for by the last two and by supervision: it would overwrite the OpenCV that is there, which
# has all of it that they use.
OVERWRITES_OPENCV = "opencv-python=="
# The ROS wheels unpack metadata of their own besides; only what pip installed has a WHEEL file.
INSTALLED = """
from importlib.metadata import distributions
for found in distributions():
    if found.read_text("WHEEL"):
        print(f"{found.name}=={found.version}")
"""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", choices=["baselines", *BESIDE])
    parser.add_argument("--hashes", action="store_true")
    parser.add_argument("interpreters", nargs="*")
    args = parser.parse_args()
    if args.hashes:
        for path in (*sorted(HERE.glob("*.txt")), path_of("baselines")):
            header, *pins = pins_of(path)
            path.write_text(hashed(header, pins))
        return
    if args.only not in BESIDE:
        lock_by_interpreters(args.interpreters, args.only)
    for lock in BESIDE:
        if args.only in (None, lock):
            lock_beside(lock)


def lock_by_interpreters(interpreters: list[str], only: str | None) -> None:
    """Write every lock but docs, or the one that is named."""
    locks: dict[str, dict[str, set[str]]] = {}
    for interpreter in interpreters:
        version = run(interpreter, "-c", "import sys; print('%d.%d' % sys.version_info[:2])")[0]
        baselines = resolve(interpreter, BASELINES)
        pins = {"baselines": without_opencv(baselines)}
        if only is None:
            pins |= own_pins(interpreter, version)
        for lock, found in pins.items():
            locks.setdefault(lock, {})[version] = found
    for lock, by_version in locks.items():
        header = f"# Written by requirements/lock.py for Python {', '.join(by_version)}."
        path_of(lock).write_text(hashed(header, merged(by_version)))


def path_of(lock: str) -> Path:
    """Return the file of a lock; that of the baselines is installed with the package."""
    folder = ROOT / "vehicle_pf_tracker" / "evaluation" if lock == "baselines" else HERE
    return folder / f"{lock}.txt"


def lock_beside(lock: str) -> None:
    """Write a lock of what is installed beside locked.txt, resolved for all Pythons at once."""
    base = pins_of(HERE / "locked.txt")[1:]
    found = compiled([*base, *BESIDE[lock]], "--no-annotate")
    known = {key_of(pin) for pin in base}
    pins = [pin for pin in found if key_of(pin) not in known]
    (HERE / f"{lock}.txt").write_text(hashed("# Written by requirements/lock.py.", pins))


def own_pins(interpreter: str, version: str) -> dict[str, set[str]]:
    """Return the pins of every lock that this package itself is installed with."""
    base = without_opencv(resolve(interpreter, (*BASE, *EXAMPLES)))
    pins = {
        "locked": base,
        "ros-jazzy": resolve(interpreter, ROS) - base,
        "ros-kilted": resolve(interpreter, KILTED) - base,
        "colcon": resolve(interpreter, COLCON) - base,
    }
    if version in {"3.10", "3.11", "3.12"}:  # NumPy 1.26 has no wheels for later ones
        pins["noble"] = resolve(interpreter, NOBLE)
    return pins


def without_opencv(pins: set[str]) -> set[str]:
    """Leave out the package that would overwrite another OpenCV."""
    return {pin for pin in pins if not pin.startswith(OVERWRITES_OPENCV)}


def resolve(interpreter: str, wanted: tuple[str, ...]) -> set[str]:
    """Return what pip installs for these requirements, as exact pins."""
    with tempfile.TemporaryDirectory() as folder:
        run(interpreter, "-m", "venv", folder)
        python = str(Path(folder, "bin", "python"))
        run(python, "-m", "pip", "uninstall", "--quiet", "--yes", "setuptools")
        run(python, "-m", "pip", "install", "--quiet", "--upgrade", "pip")
        run(python, "-m", "pip", "install", "--quiet", *wanted)
        pins = run(python, "-c", INSTALLED)
    return {pin for pin in pins if pin.split("==")[0] not in {"pip", "vehicle_pf_tracker"}}


def merged(by_version: dict[str, set[str]]) -> list[str]:
    """Join the pins of all interpreters, with markers where they differ."""
    lines = []
    pins = set[str]().union(*by_version.values())
    for pin in sorted(pins, key=str.lower):
        versions = [version for version in by_version if pin in by_version[version]]
        marker = " or ".join(f"python_version == '{version}'" for version in versions)
        lines.append(pin if len(versions) == len(by_version) else f"{pin}; {marker}")
    return lines


def pins_of(path: Path) -> list[str]:
    """Read the header and the pins of a lock, without hashes."""
    lines = [line.removesuffix("\\").rstrip() for line in path.read_text().splitlines()]
    return [line for line in lines if not line.startswith("    --hash")]


def compiled(requirements: list[str], *options: str) -> list[str]:
    """Let uv write requirements for every Python that is supported."""
    with tempfile.TemporaryDirectory() as folder:
        run(sys.executable, "-m", "venv", folder)
        run(str(Path(folder, "bin", "pip")), "install", "--quiet", "uv")
        wanted = Path(folder, "pins.in")
        wanted.write_text("\n".join(requirements) + "\n")
        uv = (str(Path(folder, "bin", "uv")), "pip", "compile", "--python-version", "3.10")
        return run(*uv, "--quiet", "--universal", "--no-header", *options, str(wanted))


def hashed(header: str, pins: list[str]) -> str:
    """Write a lock: each pin with the hashes of every file of its version."""
    lines = compiled(pins, "--no-deps", "--generate-hashes", "--no-annotate")
    found = hashes_by_pin(lines)
    entries = (" \\\n    ".join([pin, *sorted(found[key_of(pin)])]) for pin in pins)
    return "\n".join([header, *entries]) + "\n"


def hashes_by_pin(lines: list[str]) -> dict[str, set[str]]:
    """Read ``name==version`` lines followed by lines of hashes."""
    found: dict[str, set[str]] = {}
    key = ""
    for line in lines:
        if "==" in line.partition(";")[0]:
            key = key_of(line)
        found.setdefault(key, set()).update(re.findall(r"--hash=\S+", line))
    return found


def key_of(pin: str) -> str:
    """Return ``name==version`` with the name as indexes write it."""
    name, _, version = pin.partition(";")[0].rstrip(" \\").partition("==")
    return f"{re.sub(r'[-_.]+', '-', name).lower()}=={version}"


def run(*command: str) -> list[str]:
    print("+", *command, file=sys.stderr)
    done = subprocess.run(command, check=True, text=True, stdout=subprocess.PIPE, cwd=HERE)
    return done.stdout.splitlines()


if __name__ == "__main__":
    main()
