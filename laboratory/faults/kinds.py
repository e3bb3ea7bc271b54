# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Kinds of faults by their name, and the trial that gives each."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from laboratory.faults.detector_trial import give_detector_faults
from laboratory.faults.files_trial import give_files
from laboratory.faults.messages_trial import give_messages
from laboratory.faults.node_process import FaultError, Tester
from laboratory.faults.soak import Soak
from laboratory.faults.vision_messages import vision_messages

if TYPE_CHECKING:
    from laboratory.faults.request import Request


def give(kind: str, request: Request, folder: Path) -> bool:
    """Give the faults of a kind and print what came of them; return whether all held."""
    # A tester for each kind: nothing of one is heard in the next.
    tester = Tester()
    give_kind = {
        "messages": partial(_messages, tester, request),
        "detector": partial(_detector, tester, request, folder),
        "soak": partial(_soak, tester, request, folder),
    }.get(kind, partial(give_files, kind, request.count, request.seed))
    try:
        return give_kind()
    except FaultError as error:
        print(error)
        return False
    finally:
        tester.close()


def _messages(tester: Tester, request: Request) -> bool:
    return give_messages(tester, request.variant, request.count, request.seed)


def _detector(tester: Tester, request: Request, folder: Path) -> bool:
    messages = None if request.motion else vision_messages(folder)
    return give_detector_faults(tester, messages, request.seconds, request.only)


def _soak(tester: Tester, request: Request, folder: Path) -> bool:
    soak = Soak(tester, request, folder)
    soak.run()
    return soak.report()
