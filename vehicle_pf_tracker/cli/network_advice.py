# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Advice to use a network where motion joins vehicles in blobs."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from pathlib import Path

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.detection.parameters import MOTION_DETECTOR
from vehicle_pf_tracker.evaluation.evaluation_folder import read_document
from vehicle_pf_tracker.following.networks.known_networks import KNOWN_NETWORKS
from vehicle_pf_tracker.results.run_folder import RUN_FILE
from vehicle_pf_tracker.trackers.traffic.detection_totals import DetectionTotals

_AMBIGUOUS = 0.35
"""Share of images with ambiguous blobs above which a network counts better: on clips with truth, at
.28 and .30 counts at lines were within one of ten, from .45 on a tenth to all were missed."""
_WORTH_SAYING = 1.0
"""Least mean number of vehicles without a number that is reported: one at any time. Roads whose
counts are exact have .8 to 1.2 by the estimate (laboratory/notes/traffic.md)."""
_MOST_NAMED = 5
"""Sources that the advice names, what a line of a terminal holds."""
_OWN = ("--detector",)
"""Option that chooses motion, and cannot stand beside `--model`."""
_OUTPUT = ("-o", "--output")
"""Options of the folder of results: there they are already."""
_VIDEO = "--video"
"""Option of the video, which is there already, too."""


def network_advice(command: Sequence[str], folder: Path, detected: DetectionTotals) -> list[str]:
    """Return a sentence where a network would have counted better; else none.

    Parameters
    ----------
    command : sequence of str
        Command line of a run by motion.
    folder : Path
        Folder of its results.
    detected : DetectionTotals
        What motion has detected in it.
    """
    if not _is_ambiguous(detected):
        return []
    return [
        f"in {detected.ambiguous / detected.images:.0%} of the images {_advice(command, folder)}"
    ]


def joined_vehicles(detected: DetectionTotals) -> list[str]:
    """Return a sentence about vehicles that motion cannot separate; none where there are few."""
    mean = detected.mean_unresolved
    if mean is not None and mean >= _WORTH_SAYING:
        return [
            f"about {mean:.1f} vehicles at a time were in blobs with others and have no number, by "
            f"the blobs' size in {detected.sized} of {detected.images} images"
        ]
    if mean is None and _is_ambiguous(detected):
        return [
            "how many vehicles were in blobs with others cannot be told: too few drove apart to "
            "learn how large they are"
        ]
    return []


def advice_over_sources(command: Sequence[str], folder: Path, folders: Sequence[Path]) -> list[str]:
    """Return a sentence where a network would have counted better in a source; else none.

    Parameters
    ----------
    command : sequence of str
        Command line over all sources.
    folder : Path
        Folder over all.
    folders : sequence of Path
        Folders of the sources; those without results, or without motion, say nothing.
    """
    names = [source.name for source in folders if _is_ambiguous(_found_in(source))]
    if not names:
        return []
    where = f"{len(names)} of {len(folders)} sources ({', '.join(names[:_MOST_NAMED])}"
    where += ", …)" if len(names) > _MOST_NAMED else ")"
    return [f"in {where} {_advice(command, folder)}"]


def _is_ambiguous(detected: DetectionTotals) -> bool:
    return detected.ambiguous > _AMBIGUOUS * detected.images


def _found_in(folder: Path) -> DetectionTotals:
    """Read what motion has detected in a run; nothing for a run that failed, or without motion."""
    try:
        document = read_document(folder / RUN_FILE)
    except InputError:  # it failed, and that was said
        return DetectionTotals()
    if document.get("detector") != MOTION_DETECTOR:
        return DetectionTotals()
    return DetectionTotals(
        images=document["images_with_detections"],
        ambiguous=document["images_with_ambiguous_blobs"],
    )


def _advice(command: Sequence[str], folder: Path) -> str:
    """Return the advice, with the line that repeats a command with a network."""
    network = next(iter(KNOWN_NETWORKS))
    words = _without(command, _OWN)
    words = [*_other_video(words, network), "--model", network]
    line = shlex.join([*_without(words, _OUTPUT), "-o", f"{folder}_{network}"])
    return f"blobs may have held several vehicles; a network tells them apart: {line}"


def _without(words: Sequence[str], names: Sequence[str]) -> list[str]:
    """Return the words without options of these names and their values."""
    kept: list[str] = []
    before = ""
    for word in words:
        if before not in names and word not in names and word.partition("=")[0] not in names:
            kept.append(word)
        before = word
    return kept


def _other_video(words: Sequence[str], network: str) -> list[str]:
    """Return the words with another name of the video, which would not be replaced."""
    renamed: list[str] = []
    for word in words:
        option, equals, name = word.partition("=")
        if renamed and renamed[-1] == _VIDEO:
            renamed.append(_named(word, network))
        elif option == _VIDEO and equals:
            renamed.append(f"{option}={_named(name, network)}")
        else:
            renamed.append(word)
    return renamed


def _named(video: str, network: str) -> str:
    path = Path(video)
    return str(path.with_name(f"{path.stem}_{network}{path.suffix}"))
