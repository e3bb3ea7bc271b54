"""Compiling with numba, typed, and kept on disk wherever there is a place for it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import numba

FunctionT = TypeVar("FunctionT", bound=Callable[..., Any])

NOT_KEPT = (
    "compiled kernels cannot be kept on disk ({}); each start compiles them again, for some "
    "seconds: set NUMBA_CACHE_DIR to a folder that can be written"
)

_notices: list[str] = []


def compiled(*signatures: Any) -> Callable[[FunctionT], FunctionT]:
    """Compile a function for these signatures at once, or load what was compiled before.

    Numba looks for a writable folder beside the module, then in the user's cache folder. Sums may
    be reordered (`reassoc`), which is the same in every run of one machine code; nothing else of
    IEEE arithmetic is given up.

    A function that is called by compiled ones (`inlined`) has to stand in the same file: numba
    compiles anew what changed in a file, and does not look further.
    """

    def compile_it(function: FunctionT) -> FunctionT:
        try:
            return _compile(function, list(signatures), keep=True)
        except Exception as error:  # no folder, a full disk, or what a torn file makes of pickle
            if not _notices:
                _notices.append(NOT_KEPT.format(str(error).partition("\n")[0]))
            return _compile(function, list(signatures), keep=False)

    return compile_it


def inlined(function: FunctionT) -> FunctionT:
    """Make a part of the compiled functions of the same file."""
    made: FunctionT = numba.njit(fastmath={"reassoc", "contract"})(function)
    return made


def notices() -> list[str]:
    """Tell what was not as it should be while compiling, a sentence each."""
    return list(_notices)


def _compile(function: FunctionT, signatures: list[Any], *, keep: bool) -> FunctionT:
    made: FunctionT = numba.njit(signatures, cache=keep, fastmath={"reassoc", "contract"})(function)
    return made
