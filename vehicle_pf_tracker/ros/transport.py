# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A shared-memory segment that whole images fit into, for Fast DDS.

The default segment of half a megabyte loses most of the images that best-effort subscribers are
sent. The publisher's segment decides, and it can be set only before the process makes its first
participant.

The profile also makes its participants announce themselves every second instead of every 3 s. A
participant of Fast DDS (2.14 and 3.6 alike) announces itself when it starts, and only then begins
to read: the one answer of a participant that was there before comes within a millisecond, and a
third of all starts lose it. Both then wait for the next announcement of the older one.
"""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator, Mapping, MutableMapping
from contextlib import contextmanager
from importlib import resources
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

PROFILE_VARIABLES = ("FASTRTPS_DEFAULT_PROFILES_FILE", "FASTDDS_DEFAULT_PROFILES_FILE")
"""Where Fast DDS 2 (Jazzy) and Fast DDS 3 (Kilted) look for a profile."""

_FIRST_WITH_FAST_DDS_3 = 8
"""Major version of rclpy after Jazzy's; each warns of the other's variable or does not read it."""

USER_VARIABLES = (*PROFILE_VARIABLES, "FASTDDS_BUILTIN_TRANSPORTS")
"""Where a user chooses transports; nothing is changed if one of them is set."""

SHARED_MEMORY = Path("/dev/shm")  # noqa: S108 (the system's place for it)
IMAGES_PER_SEGMENT = 4
"""Images that a segment has room for: one that is written, one that is read, and two that wait."""
SMALLEST_SEGMENT = 4 * 1024 * 1024
"""Bytes of a segment at least: four raw VGA images, with which none of 150 was lost at 30 Hz."""
_LARGEST_SEGMENT = 2**31
"""Bytes of a segment at most: Fast DDS counts them in 32 bits, and a sign may be among these."""

LAUNCHED_SEGMENT = 64 * 2**20
"""Bytes of shared memory for `large_images` of the launch files, as ``config/large_images.xml`` has
them: ten raw images of 1080p, or two of 4K."""


def segment_size(image_bytes: int, free_bytes: int) -> int | None:
    """Size of the segment for images of `image_bytes`, or None where there is no room for one.

    Four images, at least 4 MB, and never more than half of what is free in shared memory; a
    segment that does not hold two images is of no use.
    """
    wanted = max(IMAGES_PER_SEGMENT * image_bytes, SMALLEST_SEGMENT)
    size = min(wanted, free_bytes // 2, _LARGEST_SEGMENT)
    return size if size >= max(2 * image_bytes, SMALLEST_SEGMENT // 2) else None


def profile(size: int) -> str:
    """Write the XML profile: a shared-memory segment of `size` bytes, UDP beside it, discovery."""
    text = resources.files(__package__).joinpath("transport.xml").read_text(encoding="utf-8")
    return text.format(segment_size=size)


def is_free_to_choose(environment: Mapping[str, str], middleware: str) -> bool:
    """Return whether the middleware is Fast DDS and the user has not chosen its transports."""
    is_fast_dds = middleware.startswith("rmw_fastrtps")
    return is_fast_dds and not any(environment.get(name) for name in USER_VARIABLES)


def profile_variable() -> str:
    """Name of the variable that this release's Fast DDS reads."""
    try:
        release = int(version("rclpy").partition(".")[0])
    except (PackageNotFoundError, ValueError):
        release = 0
    return PROFILE_VARIABLES[release >= _FIRST_WITH_FAST_DDS_3]


@contextmanager
def image_transport(
    image_bytes: int, middleware: str, environment: MutableMapping[str, str] = os.environ
) -> Iterator[list[str]]:
    """Give the participants that are made meanwhile a segment that fits the images.

    Child processes that are started meanwhile inherit it. A profile of the user's own is never
    overridden, and other middlewares than Fast DDS are left alone.

    Parameters
    ----------
    image_bytes : int
        Size of the largest message.
    middleware : str
        As ``rclpy.get_rmw_implementation_identifier()`` names it.
    environment : mutable mapping
        Environment that names the profile; that of this process by default.

    Yields
    ------
    list of str
        Notices for the user, a sentence each.
    """
    if not is_free_to_choose(environment, middleware):
        yield []
        return
    free = shutil.disk_usage(SHARED_MEMORY).free if SHARED_MEMORY.is_dir() else 0
    size = segment_size(image_bytes, free)
    if size is None:
        yield [
            f"{SHARED_MEMORY} has only {free / 1e6:.1f} MB free, too little for images of "
            f"{image_bytes / 1e6:.1f} MB: frames may be lost on the way, so use --lockstep"
        ]
        return
    with tempfile.TemporaryDirectory(prefix="vehicle_pf_tracker_") as folder:
        path = Path(folder, "transport.xml")
        path.write_text(profile(size), encoding="utf-8")
        name = profile_variable()
        environment[name] = str(path)
        try:
            yield []
        finally:
            environment.pop(name, None)
