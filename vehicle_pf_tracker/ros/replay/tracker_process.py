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

"""A tracker node as a process of its own, for as long as it is needed."""

from __future__ import annotations

import signal
import subprocess
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import NamedTuple

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.offline.processes import wait_or_kill
from vehicle_pf_tracker.parameters.table import Value

_SCRIPT = "import sys; from vehicle_pf_tracker.ros.executables import main; sys.exit(main({!r}))"


class TrackerProcess(NamedTuple):
    """Process of a node."""

    variant: str
    process: subprocess.Popen[bytes]

    def check(self) -> None:
        """Raise `InputError` once the node has ended; while it has not, a wait may be long."""
        if self.process.poll() is not None:
            raise InputError(f"the node {self.variant}_tracker has ended; see its log above")


@contextmanager
def tracker_process(
    variant: str, parameters: Mapping[str, Value], image_topic: str
) -> Iterator[TrackerProcess]:
    """Run the node of `variant` until the block ends.

    Parameters
    ----------
    variant : str
        Name in the registry.
    parameters : mapping
        Parameters over the defaults, by dotted name.
    image_topic : str
        Topic that its `image` input is remapped to.

    Raises
    ------
    InputError
        If the node ended by itself with an error.
    """
    words = ["--ros-args", "--log-level", "warn", "-r", f"image:={image_topic}"]
    for name, value in parameters.items():
        words += ["-p", f"{name}:={str(value).lower() if isinstance(value, bool) else value}"]
    # The very same interpreter: another one's libraries would be looked up in this one's place.
    process = subprocess.Popen([sys.executable, "-c", _SCRIPT.format(variant), *words])
    try:
        yield TrackerProcess(variant, process)
    finally:
        # Not SIGINT, which a process begun in a shell's background inherits as ignored.
        process.terminate()
        status = wait_or_kill(process)
    if status not in {0, -signal.SIGTERM}:
        raise InputError(
            f"the node {variant}_tracker ended with status {status}; see its log above"
        )
