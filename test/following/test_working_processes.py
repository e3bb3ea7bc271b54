# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import signal
import subprocess
import sys

from vehicle_pf_tracker.following import processes
from vehicle_pf_tracker.following.processes import wait_or_kill


def test_one_that_ends_gives_its_status():
    process = subprocess.Popen([sys.executable, "-c", "raise SystemExit(3)"])
    assert wait_or_kill(process) == 3


def test_one_that_will_not_end_is_killed(monkeypatch):
    monkeypatch.setattr(processes, "PATIENCE", 0.1)
    deaf = (
        "import signal; signal.signal(signal.SIGTERM, signal.SIG_IGN);"
        "print('deaf', flush=True); signal.pause()"
    )
    with subprocess.Popen([sys.executable, "-c", deaf], stdout=subprocess.PIPE) as process:
        assert process.stdout.readline() == b"deaf\n"
        process.terminate()
        assert wait_or_kill(process) == -signal.SIGKILL
