# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Machine code of whole kernels alone, and not of each of their parts.

Numba optimises every function that a kernel calls (each `min` of a type is one), makes machine code
of it, and does so again in whatever calls it. Nobody calls a part by itself, and the whole is
optimised with all parts in it, so that their own code serves nothing: it is half of compiling.

Private names of numba stand here and in `compilation`; where one is missing, numba compiles as it
always does.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numba.core.registry
from numba.core.compiler_lock import global_compiler_lock

_WRAPPER = "_ZN7cpython"
"""Beginning of the names of the functions that Python calls, as numba mangles them; no part has
one."""
_OF_LIBRARY = "_finalize_dynamic_globals", "_finalize_final_module", "_optimize_final_module"
"""Methods of numba's libraries of code that are replaced, or called in their place."""


@contextmanager
def only_wholes() -> Iterator[None]:
    """Let numba make machine code of functions that Python calls, and of no others."""
    codegen = _codegen()
    if codegen is None:
        yield
        return
    # Held throughout: functions that another thread compiles are no kernels.
    with global_compiler_lock:
        set_env = codegen.set_env
        address_of = codegen._engine.get_global_value_address

        def set_env_of_whole(name: str, env: Any) -> None:
            # A part without machine code has no variable for it, and needs none.
            if address_of(name):
                set_env(name, env)

        codegen._library_class = _library_of_wholes(codegen._library_class)
        codegen.set_env = set_env_of_whole
        try:
            yield
        finally:
            # Those of its class come back.
            del codegen._library_class
            del codegen.set_env


def _codegen() -> Any | None:
    """Return the object that makes numba's code; None where it is not as it was."""
    try:
        codegen = numba.core.registry.cpu_target.target_context.codegen()
        names = [getattr(codegen._library_class, name) for name in _OF_LIBRARY]
        names += [codegen.set_env, codegen._engine.get_global_value_address]
    except AttributeError:
        return None
    return codegen if all(map(callable, names)) else None


def _library_of_wholes(library: type[Any]) -> type[Any]:
    """Derive a class of libraries that do not make machine code of a part."""

    class Library(library):  # type: ignore[misc]
        @property
        def _is_part(self) -> bool:
            names = [function.name for function in self._final_module.functions]
            return not any(name.startswith(_WRAPPER) for name in names)

        def _optimize_final_module(self) -> None:
            if not self._is_part:
                super()._optimize_final_module()

        def _finalize_final_module(self) -> None:
            if self._is_part:
                self._finalize_dynamic_globals()
                self._finalized = True
            else:
                super()._finalize_final_module()

    return Library
