# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Folders that appear whole or not at all."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


class OutputFolder:
    """Collects files in a hidden folder beside `target`, which takes its place at the end.

    Parameters
    ----------
    target : Path
        The folder to make; what is there under its name is replaced.

    Attributes
    ----------
    partial : Path
        The hidden folder.

    Raises
    ------
    OSError
        If it cannot be written; also from `publish`.
    """

    def __init__(self, target: Path) -> None:
        self.target = target.expanduser().resolve()
        self.partial = self.target.parent / f".{self.target.name}.{os.getpid()}.partial"
        self.partial.mkdir(parents=True)

    def publish(self) -> None:
        """Put the finished folder in its place; a former one goes when it is there."""
        former = self.partial.with_suffix(".former")
        try:
            if self.target.exists():
                self.target.rename(former)
            self.partial.rename(self.target)
        except BaseException:  # a signal too
            if former.exists() and not self.target.exists():
                former.rename(self.target)
            raise
        shutil.rmtree(former, ignore_errors=True)

    def discard(self) -> None:
        """Remove what was collected."""
        shutil.rmtree(self.partial, ignore_errors=True)


@contextmanager
def whole_folder(target: Path) -> Iterator[Path]:
    """Give an `OutputFolder` to fill; it is published if the block ends well, else removed."""
    output = OutputFolder(target)
    try:
        yield output.partial
        output.publish()
    finally:
        output.discard()
