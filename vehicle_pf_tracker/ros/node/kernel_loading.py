# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Loading of a variant's kernels in a thread of its own, as to compile them takes a while."""

from __future__ import annotations

import threading
from contextlib import suppress
from typing import Any

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.image.kernels.interface import load_kernels, may_compile
from vehicle_pf_tracker.ros.library_memory import LINKER, give_back_library
from vehicle_pf_tracker.ros.messages import NOT_READY
from vehicle_pf_tracker.trackers.registry import Variant
from vehicle_pf_tracker.trackers.rehearsal import rehearse

_THREAD = "loading kernels"
"""Name of the threads, by which `is_loading` finds those of all nodes of the process."""
_REASON = f"{NOT_READY}; the first start compiles them, for up to a minute"
"""Answer to every image meanwhile."""
_rehearsed: set[str] = set()
"""Variants whose kernels this process has."""


class KernelLoading:
    """Loads the kernels of a variant in a thread of its own where that takes long, else at once.

    Numba leaves the interpreter to others while LLVM works, and most of the time goes there: the
    node answers its services and obeys signals meanwhile.

    Parameters
    ----------
    variant : Variant
        Variant from the registry: only what its step needs is compiled.
    parameters : dataclass
        Parameters of the variant.

    Raises
    ------
    InputError
        If numba's kernels are asked for where numba is not installed.
    """

    def __init__(self, variant: Variant, parameters: Any) -> None:
        self.choice = parameters.kernels
        self._variant = variant
        self._parameters = parameters
        self._problem = ""
        self._thread: threading.Thread | None = None
        if may_compile(self.choice) and variant.name not in _rehearsed:
            # A daemon: a compilation cannot be ended, and a node that is stopped does not wait for
            # it.
            self._thread = threading.Thread(target=self._load, name=_THREAD, daemon=True)
            self._thread.start()
        else:
            load_kernels(self.choice)

    @property
    def is_done(self) -> bool:
        """True once the kernels are loaded."""
        return not self._problem and not (self._thread is not None and self._thread.is_alive())

    @property
    def reason(self) -> str:
        """Reason why there are no kernels (yet), in one sentence."""
        return self._problem or _REASON

    def _load(self) -> None:
        try:
            kernels = load_kernels(self.choice)
        except InputError as error:
            self._problem = str(error)
        except Exception as error:  # as numba raises it; the node lives and says so
            self._problem = f"the kernels cannot be loaded: {type(error).__name__}: {error}"
        else:
            if kernels.name == "numba":
                with suppress(Exception):  # a plug-in's own; its first image shows it
                    rehearse(self._variant, self._parameters)
            # A kernel that is linked later reads some of it again.
            give_back_library(LINKER)
            # Also where the rehearsal failed: its kernels are compiled as they are called, as
            # without it.
            _rehearsed.add(self._variant.name)


def is_loading() -> bool:
    """Return whether a thread of this process still loads kernels; it cannot be ended."""
    return any(thread.name == _THREAD for thread in threading.enumerate())
