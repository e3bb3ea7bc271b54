# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Irregularities of a recording, collected while it is read."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.recordings.bags.mcap_blocks import Block, DamageError
from vehicle_pf_tracker.recordings.bags.mcap_index import McapIndex


class ReadNotices:
    """Collects irregularities while a recording is read; each counts once.

    Parameters
    ----------
    path : Path
        The recording.
    image_topic : str
        The topic whose images are counted.
    found : iterable of str
        Irregularities found before, a sentence each.
    files : iterable of McapIndex
        Indexes of the files in order, which report damage.
    """

    def __init__(
        self, path: Path, image_topic: str, found: Iterable[str], files: Iterable[McapIndex]
    ) -> None:
        self._path = path
        self._image_topic = image_topic
        self._sentences = list(found)
        self._unreadable: dict[int, str] = {}
        # By part of the file, so that reading it twice counts it once.
        self._damages: dict[tuple[Path, int], str] = {}
        frames = 0
        # Added up over the files: a split recording is truncated after the frames of all before.
        for index in files:
            of_topic = (n for n, one in index.channels.items() if one.topic == image_topic)
            frames += sum(index.counts[number] for number in of_topic)
            self._sentences += [f"recording {index.path}: {damage}" for damage in index.damages]
            if index.is_truncated:
                self._sentences.append(
                    f"recording {index.path} is truncated after frame {frames}; "
                    "what was readable is used"
                )

    @property
    def sentences(self) -> list[str]:
        """Sentences collected so far."""
        sentences = [*self._sentences, *self._damages.values()]
        if self._unreadable:
            sentences.append(
                f"unreadable images of {self._image_topic} in {self._path}: "
                f"{len(self._unreadable)}; {next(iter(self._unreadable.values()))}"
            )
        return sentences

    @property
    def first_reason(self) -> str:
        """Reason why the first image, or else the first part, could not be read."""
        return next(iter([*self._unreadable.values(), *self._damages.values()]))

    def add_block(self, index: McapIndex, block: Block, error: DamageError) -> None:
        """Note a part of a file that was skipped."""
        self._damages[index.path, block.offset] = (
            f"recording {index.path}: a part at {index.unit} {block.offset} was skipped: {error}"
        )

    def add_image(self, log_time_ns: int, start_ns: int, error: InputError) -> None:
        """Note an image that could not be decoded."""
        seconds = (log_time_ns - start_ns) / 1e9
        # By time: reading twice must not count an image twice.
        self._unreadable[log_time_ns] = f"{seconds:.3f} s after the start: {error}"

    def add_missing(self, count: int) -> None:
        """Note images that should be there, unless a damage explains it."""
        # A damaged part explains what is missing; two sentences would be one too many.
        if count > 0 and not self._damages:
            # No part of a file begins at -1.
            self._damages[self._path, -1] = (
                f"recording {self._path}: {count} images that its index lists are missing"
            )
