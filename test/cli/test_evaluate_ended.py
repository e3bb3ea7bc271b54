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

"""An evaluation that is ended from outside, and goes on."""

import csv
import signal
import subprocess
import sys
import time

import pytest
from small_recordings import record
from unmeasured import unmeasured_environment

from vehicle_pf_tracker.cli.main import main

# Those who start us in the background may have had SIGINT ignored, which a child inherits.
CODE = (
    "import signal, sys; signal.signal(signal.SIGINT, signal.default_int_handler)\n"
    "from vehicle_pf_tracker.cli.main import main; sys.exit(main())"
)


def estimates(folder):
    return {
        str(path.relative_to(folder)): [
            {name: text for name, text in row.items() if name != "step_ms"}
            for row in csv.DictReader(path.open())
        ]
        for path in sorted(folder.glob("cells/*/*/seed-*/estimates.csv"))
    }


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_what_was_ended_goes_on_and_comes_out_the_same(tmp_path, number):
    record(tmp_path / "bag")
    words = ["evaluate", str(tmp_path / "bag"), "--variants", "pf,ms", "--seeds", "60"]
    words += ["--no-images", "--workers", "2", "-o"]
    ended, whole = tmp_path / "ended", tmp_path / "whole"
    process = subprocess.Popen(
        [sys.executable, "-c", CODE, *words, str(ended)], stderr=subprocess.PIPE, text=True,
        env=unmeasured_environment(),
    )  # fmt: skip
    try:
        deadline = time.monotonic() + 60
        while len(estimates(ended)) < 5 and time.monotonic() < deadline:
            time.sleep(0.02)
        process.send_signal(number)
        _, told = process.communicate(timeout=20)
    finally:
        process.kill()
    assert "Traceback" not in told
    assert process.returncode == (130 if number == signal.SIGINT else -number)
    assert ("interrupted; run the same command to resume" in told) == (number == signal.SIGINT)
    before = {
        path: path.stat().st_mtime_ns for path in ended.glob("cells/*/*/seed-*/estimates.csv")
    }
    assert 5 <= len(before) < 61
    assert not (ended / "report.html").exists()
    assert main([*words, str(ended)]) == 0
    assert {path: path.stat().st_mtime_ns for path in before} == before
    assert main([*words, str(whole)]) == 0
    assert len(estimates(whole)) == 61
    assert estimates(ended) == estimates(whole)
