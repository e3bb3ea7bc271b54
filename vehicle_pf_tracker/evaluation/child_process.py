"""The end of a process that this one began."""

from __future__ import annotations

import subprocess

_PATIENCE = 10.0


def wait_or_kill(process: subprocess.Popen[bytes] | subprocess.Popen[str]) -> int:
    """Wait for a process that was asked to end, and kill it after 10 s; returns its status."""
    try:
        return process.wait(_PATIENCE)
    except subprocess.TimeoutExpired:
        process.kill()
        return process.wait()
