# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The rosbag2 folder: which files it consists of, and its metadata.yaml (version 9).

Read by rosbag2's `MetadataIo` and by `rosbags`; the field names are rosbag2_storage's.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path, PurePath
from typing import Any

import yaml

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.recordings.bags.messages import type_hash
from vehicle_pf_tracker.recordings.recording_names import CONVERSION, MCAP_SUFFIX, SQLITE_SUFFIX

VERSION = 9
"""Version of metadata.yaml that is written: that of rosbag2 in Jazzy."""
_INFINITE = {"sec": 9223372036, "nsec": 854775807}
"""Duration by which ROS says "without limit": the largest int64 in ns."""
RELIABLE_QOS: list[dict[str, Any]] = [
    {
        "history": "keep_last",
        "depth": 10,
        "reliability": "reliable",
        "durability": "volatile",
        "deadline": _INFINITE,
        "lifespan": _INFINITE,
        "liveliness": "automatic",
        "liveliness_lease_duration": _INFINITE,
        "avoid_ros_namespace_conventions": False,
    }
]
"""The QoS profiles that every topic of our recordings offers."""


def recording_files(path: Path) -> tuple[list[Path], list[str]]:
    """List the files of a rosbag2 folder, or the one file that `path` is.

    Returns
    -------
    files : list of Path
        Files in the order of recording.
    notices : list of str
        Irregularities that could be worked around, a sentence each.

    Raises
    ------
    InputError
        If there is no such path, or nothing in it is a recording.
    """
    try:
        if not path.exists():
            raise InputError(f"there is no recording {path}")
        if path.is_dir():
            return _folder_files(path)
        if not path.is_file():
            raise InputError(f"the recording {path} is not a regular file")
        return [path], []
    except OSError as error:
        raise InputError(f"cannot read the recording {path}: {error.strerror}") from error


def _folder_files(folder: Path) -> tuple[list[Path], list[str]]:
    metadata = folder / "metadata.yaml"
    information = _information(metadata)
    if information is not None:
        _check_storage(folder, information)
        return _listed_files(folder, information)
    # A recorder that was killed has written no metadata: the files are whole all the same.
    state = "damaged" if metadata.exists() else "missing"
    # MCAP first: it is the format of our own recordings, should a folder have both.
    for suffix in (MCAP_SUFFIX, SQLITE_SUFFIX):
        present = [path for path in folder.glob(f"[!.]*{suffix}") if path.is_file()]
        if present:
            notice = f"{metadata} is {state}; the *{suffix} files beside it are used"
            return sorted(present, key=_natural_order), [notice]
    raise InputError(f"the folder {folder} holds no recording (metadata.yaml, *.mcap, *.db3)")


def _information(metadata: Path) -> dict[str, Any] | None:
    """Read what the metadata say of a recording; None where they are missing or damaged."""
    try:
        if not metadata.is_file():
            return None
        information = yaml.safe_load(metadata.read_text())["rosbag2_bagfile_information"]
        files = information["relative_file_paths"]
        words = [information.get(key) or "" for key in ("storage_identifier", "compression_mode")]
    # ValueError: bytes that are not text, numbers of thousands of digits, dates that are none.
    except (yaml.YAMLError, ValueError, RecursionError, KeyError, TypeError, AttributeError):
        return None
    # Checked for its types here, so that nothing below has to doubt what it reads.
    is_sound = isinstance(files, list) and files and all(isinstance(w, str) for w in files + words)
    return information if is_sound else None


def _check_storage(folder: Path, information: dict[str, Any]) -> None:
    storage = information.get("storage_identifier") or "mcap"
    if storage not in {"mcap", "sqlite3"}:
        raise InputError(
            f"the recording {folder} is stored as {storage}; convert it to MCAP where it was made"
        )
    mode = (information.get("compression_mode") or "").lower()
    if mode not in {"", "none", "storage"}:
        raise InputError(
            f"the recording {folder} is compressed by {mode}; convert it: "
            f"{CONVERSION.format(path=folder)}, or record with `--storage-preset-profile zstd_fast`"
        )


def _listed_files(folder: Path, information: dict[str, Any]) -> tuple[list[Path], list[str]]:
    names = [PurePath(name) for name in information["relative_file_paths"]]
    for name in names:
        # A bag from elsewhere must not have files read that lie beside it.
        if name.is_absolute() or ".." in name.parts:
            raise InputError(
                f"{folder / 'metadata.yaml'} lists the file {name}, which is outside of its folder"
            )
    listed = [folder / name for name in names]
    present = [path for path in listed if path.is_file()]
    if not present:
        raise InputError(f"the recording {folder} lacks its file {listed[0].name}")
    # A split bag of which one part was not copied is worth the parts that there are.
    lacking = [path.name for path in listed if path not in present]
    notices = [f"recording {folder} lacks its file {name}; the rest is used" for name in lacking]
    return present, notices


def _natural_order(path: Path) -> list[tuple[int, str]]:
    """Sort `bag_2` before `bag_10`."""
    return [(int(digits or 0), text) for text, digits in re.findall(r"(\D*)(\d*)", path.stem)]


class _PlainDumper(yaml.SafeDumper):
    """Writes equal values out each time: rosbag2's readers need not know YAML's aliases."""

    def ignore_aliases(self, data: Any) -> bool:
        return True


def bag_information(
    file_name: str, start_ns: int, duration_ns: int, topics: Mapping[str, tuple[str, int]]
) -> dict[str, Any]:
    """Describe a bag of one MCAP file.

    Parameters
    ----------
    file_name : str
        Name of the file.
    start_ns, duration_ns : int
        Log time of its first message, and time from there to its last one, ns.
    topics : mapping of str to (str, int)
        Type of each topic, and the number of its messages.
    """
    summary = {
        "duration": {"nanoseconds": duration_ns},
        "starting_time": {"nanoseconds_since_epoch": start_ns},
        "message_count": sum(count for _, count in topics.values()),
    }
    return {
        "version": VERSION,
        "storage_identifier": "mcap",
        **summary,
        "topics_with_message_count": [
            {
                "topic_metadata": {
                    "name": name,
                    "type": type_name,
                    "serialization_format": "cdr",
                    "offered_qos_profiles": RELIABLE_QOS,
                    "type_description_hash": type_hash(type_name),
                },
                "message_count": count,
            }
            for name, (type_name, count) in topics.items()
        ],
        # rosbag2's compression, of files or messages; that of MCAP's chunks is not named here.
        "compression_format": "",
        "compression_mode": "",
        "relative_file_paths": [file_name],
        "files": [{"path": file_name, **summary}],
        "custom_data": None,
        "ros_distro": "jazzy",
    }


def to_yaml(value: Any) -> str:
    """Return the text of bag information, or of QoS profiles, as rosbag2 writes it."""
    return yaml.dump(value, Dumper=_PlainDumper, sort_keys=False)
