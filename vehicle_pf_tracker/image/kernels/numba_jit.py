# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Typed compilation with numba, cached on disk where a folder can be written.

How long it takes follows from what numba writes out for each expression. So kernels fill arrays,
copy them and search them in loops: `a[:] = b` alone takes a second and more, as it brings the
text of an error with it, and `a[:, 0].min()` as long. Arrays are made empty and filled, as zeros
are a function of their own for each type; and `x = a[i, 0]` is shorter than `x, y = a[i]`.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from typing import Any, TypeVar, cast

import numba

FunctionT = TypeVar("FunctionT", bound=Callable[..., Any])

NOT_KEPT = (
    "compiled kernels cannot be kept on disk ({}); each start compiles them again, for some "
    "seconds: set NUMBA_CACHE_DIR to a folder that can be written"
)

_FASTMATH = {"reassoc", "contract"}
"""Sums may be reordered, so that loops are vectorised, and products fused into them."""
_notices: list[str] = []


def compiled(*signatures: Any) -> Callable[[FunctionT], FunctionT]:
    """Compile a function for these signatures at once, or load what was compiled before.

    Numba uses a writable folder beside the module, else the user's cache folder. Sums may
    be reordered (`reassoc`), which is the same in every run of one machine code; nothing else of
    IEEE arithmetic is given up.

    A function that is called by compiled ones (`inlined`) has to stand in the same file: numba
    recompiles a file that changed, and not those that call into it.
    """

    def compile_it(function: FunctionT) -> FunctionT:
        # No C code calls the kernels, and a wrapper for it takes a twentieth of the compilation.
        build = functools.partial(
            numba.njit, list(signatures), fastmath=_FASTMATH, no_cfunc_wrapper=True
        )
        try:
            # Compiled here, at import, for the types that are given: a step never waits for it.
            result: FunctionT = build(cache=True)(function)
        except Exception as error:  # no folder, a full disk, or what a torn file makes of pickle
            # Once: all kernels have the same folder, and so the same trouble.
            if not _notices:
                _notices.append(NOT_KEPT.format(str(error).partition("\n")[0]))
            result = build()(function)
        return result

    return compile_it


class OnDemand:
    """A kernel that is compiled, or loaded, when it is first called: a variant needs few of a file.

    Compiled functions cannot call it; what kernels of a file share is `inlined`.

    Parameters
    ----------
    function : callable
        The kernel in Python.
    signatures : sequence
        Its types, as for `compiled`.
    """

    def __init__(self, function: Callable[..., Any], signatures: Sequence[Any]) -> None:
        self._function = function
        self._signatures = signatures
        functools.update_wrapper(self, function)

    @functools.cached_property
    def ready(self) -> Callable[..., Any]:
        """The compiled kernel."""
        return compiled(*self._signatures)(self._function)

    def __call__(self, *arguments: Any) -> Any:
        """Call the compiled kernel."""
        return self.ready(*arguments)


def on_demand(*signatures: Any) -> Callable[[FunctionT], FunctionT]:
    """Compile a function for these signatures, as `compiled` does, when it is first called."""

    def keep(function: FunctionT) -> FunctionT:
        return cast("FunctionT", OnDemand(function, signatures))

    return keep


def inlined(function: FunctionT) -> FunctionT:
    """Make a part of the compiled functions of the same file; Python cannot call it."""
    build = numba.njit(fastmath=_FASTMATH, no_cpython_wrapper=True, no_cfunc_wrapper=True)
    inner: FunctionT = build(function)
    return inner


def notices() -> Sequence[str]:
    """Return the problems met while compiling, one sentence each; later ones join them."""
    return _notices
