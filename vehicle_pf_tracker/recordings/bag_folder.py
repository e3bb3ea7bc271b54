"""Which MCAP files a recording consists of."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import yaml

from vehicle_pf_tracker.core.errors import InputError


def recording_files(path: Path) -> tuple[list[Path], list[str]]:
    """List the MCAP files of a rosbag2 folder, or the one file that `path` is.

    Returns
    -------
    files : list of Path
        In the order in which they were recorded.
    notices : list of str
        What is not as it should be but could be worked around.

    Raises
    ------
    InputError
        If there is no such path, or nothing in it is an MCAP file.
    """
    try:
        if not path.exists():
            raise InputError(f"there is no recording {path}")
        return _folder_files(path) if path.is_dir() else ([path], [])
    except OSError as error:
        raise InputError(f"cannot read the recording {path}: {error.strerror}") from error


def _folder_files(folder: Path) -> tuple[list[Path], list[str]]:
    metadata = folder / "metadata.yaml"
    present = sorted(folder.glob("*.mcap"), key=_natural_order)
    if not metadata.exists():
        if not present:
            raise InputError(f"the folder {folder} holds no recording (metadata.yaml, *.mcap)")
        return present, [f"recording {folder} has no metadata.yaml; its *.mcap files are used"]
    information = _information(metadata)
    if information is None:
        if not present:
            raise InputError(f"{metadata} is damaged, and there is no *.mcap file beside it")
        return present, [f"{metadata} is damaged; the *.mcap files beside it are used"]
    _check_storage(folder, information)
    return _listed_files(folder, information)


def _information(metadata: Path) -> dict[str, Any] | None:
    try:
        information = yaml.safe_load(metadata.read_text())["rosbag2_bagfile_information"]
        files = information["relative_file_paths"]
    except (yaml.YAMLError, UnicodeDecodeError, KeyError, TypeError):
        return None
    is_list = isinstance(files, list) and files and all(isinstance(name, str) for name in files)
    return information if is_list else None


def _check_storage(folder: Path, information: dict[str, Any]) -> None:
    storage = information.get("storage_identifier", "mcap")
    if storage != "mcap":
        raise InputError(
            f"the recording {folder} is stored as {storage}; "
            "convert it to MCAP with `ros2 bag convert`"
        )
    mode = str(information.get("compression_mode") or "").lower()
    if mode not in {"", "none", "storage"}:
        raise InputError(
            f"the recording {folder} is compressed by {mode}; convert it with `ros2 bag convert`, "
            "or record with `--storage-preset-profile zstd_fast`"
        )


def _listed_files(folder: Path, information: dict[str, Any]) -> tuple[list[Path], list[str]]:
    listed = [folder / name for name in information["relative_file_paths"]]
    present = [path for path in listed if path.is_file()]
    if not present:
        raise InputError(f"the recording {folder} lacks its file {listed[0].name}")
    lacking = [path.name for path in listed if path not in present]
    notices = [f"recording {folder} lacks its file {name}; the rest is used" for name in lacking]
    return present, notices


def _natural_order(path: Path) -> list[tuple[int, str]]:
    """Sort `bag_2` before `bag_10`."""
    return [(int(digits or 0), text) for text, digits in re.findall(r"(\D*)(\d*)", path.stem)]
