"""Where recordings are: paths and URLs, folders of them, and a copy at hand of what is far away."""

from __future__ import annotations

import atexit
import functools
import shutil
import tempfile
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any, TypeVar, cast

from vehicle_pf_tracker.core.errors import InputError

_MAKE = "make a recording of it first: `vehicle-pf-tracker import {} OUT`"
T = TypeVar("T")
_VIDEOS = frozenset({".avi", ".m4v", ".mkv", ".mov", ".mp4", ".mpeg", ".mpg", ".webm"})


def is_url(location: str) -> bool:
    """Whether `location` is a URL, and no path."""
    return "://" in location


def find_recordings(locations: Sequence[str]) -> list[str]:
    """Return the recordings that `locations` name, with folders of recordings spread out.

    Raises
    ------
    InputError
        If one names none, or something that has to be imported first.
    """
    found = [
        recording
        for location in locations
        for recording in (_at_url(location) if is_url(location) else _at_path(Path(location)))
    ]
    return list(dict.fromkeys(found))


def at_hand(location: str) -> Path:
    """Return a path to read the recording from; what a URL names is copied, once per process.

    Raises
    ------
    InputError
        If it cannot be fetched.
    """
    return _fetched(location) if is_url(location) else Path(location)


def _at_path(path: Path) -> list[str]:
    if _is_recording(path):
        return [str(path)]
    if not path.exists():
        raise InputError(f"there is no recording {path}")
    if path.is_file() and path.suffix.lower() in _VIDEOS:
        raise InputError(f"{path} is a video; {_MAKE.format(path)}")
    if path.is_file():
        raise InputError(f"{path} is no recording: give a rosbag2 folder or an MCAP file")
    if (path / "img").is_dir():
        raise InputError(f"{path} is a frame folder; {_MAKE.format(path)}")
    inside = sorted(child for child in path.iterdir() if _is_recording(child))
    if not inside:
        raise InputError(f"the folder {path} is no recording and has none in it")
    return [str(child) for child in inside]


def _is_recording(path: Path) -> bool:
    if path.is_file():
        return path.suffix == ".mcap"
    return (path / "metadata.yaml").is_file() or any(path.glob("*.mcap"))


def _at_url(url: str) -> list[str]:
    system, path = _file_system(url)

    def spread() -> Iterator[str]:
        if not system.isdir(path):
            yield path
            return
        for child in sorted(system.ls(path, detail=False)):
            if child.endswith(".mcap") or _holds_recording(system, child):
                yield child

    def look() -> list[str]:
        if not system.exists(path):
            raise InputError(f"there is no recording {url}")
        return [path] if _holds_recording(system, path) else list(spread())

    found = _asked(url, look)
    if not found:
        raise InputError(f"the folder {url} is no recording and has none in it")
    return [str(system.unstrip_protocol(name)) for name in found]


def _holds_recording(system: Any, path: str) -> bool:
    if not system.isdir(path):
        return False
    names = [name.rsplit("/", 1)[-1] for name in system.ls(path, detail=False)]
    return "metadata.yaml" in names or any(name.endswith(".mcap") for name in names)


@functools.cache
def _fetched(url: str) -> Path:
    system, path = _file_system(url)
    name = path.rstrip("/").rsplit("/", 1)[-1]
    target = Path(tempfile.mkdtemp(prefix="vehicle-pf-tracker-")) / name
    atexit.register(shutil.rmtree, target.parent, ignore_errors=True)

    def fetch() -> Path:
        if not system.isdir(path):
            system.get_file(path, str(target))
            return target
        target.mkdir()
        for child in system.ls(path, detail=False):
            if child.endswith((".mcap", "metadata.yaml")):
                system.get_file(child, str(target / child.rsplit("/", 1)[-1]))
        return target

    return _asked(url, fetch)


def _file_system(url: str) -> tuple[Any, str]:
    try:
        from fsspec.core import url_to_fs  # noqa: PLC0415 - an extra
    except ModuleNotFoundError:
        raise InputError(
            f"the recording {url} is a URL, and to read those the extra [cluster] is needed: "
            "`pip install 'vehicle_pf_tracker[cluster]'`"
        ) from None
    return _asked(url, lambda: cast("tuple[Any, str]", url_to_fs(url)))


def _asked(url: str, question: Callable[[], T]) -> T:
    """Ask the file system; it may be of any kind, and fail in any way."""
    try:
        return question()
    except InputError:
        raise
    except Exception as error:
        reason = " ".join(str(error).split()) or type(error).__name__
        raise InputError(f"cannot read the recording {url}: {reason}") from error
