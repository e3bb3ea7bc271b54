# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A kernel: a function in Python that is compiled, or loaded, when it is first called."""

from __future__ import annotations

import functools
import importlib
import inspect
import itertools
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from types import FunctionType, ModuleType
from typing import Any, TypeVar, cast

from vehicle_pf_tracker.image.kernels.toolchain.arguments import ArrayForm, check

FunctionT = TypeVar("FunctionT", bound=Callable[..., Any])

NOT_KEPT = (
    "compiled kernels cannot be kept on disk ({}); each start compiles them again, for some "
    "seconds: set NUMBA_CACHE_DIR to a folder that can be written"
)

NOT_LINKED = (
    "compiled kernels cannot be linked in later processes ({}); each start compiles them again, "
    "for some seconds: install another version of numba"
)

_CHECKED_CALLS = 100
"""Calls of a kernel whose arrays are checked. Types and layouts follow from the few places that
call it, not from the images; a check of each call takes as long as the call itself. A choice: some
images' calls."""
_notices: list[str] = []
_making = threading.RLock()
"""Held while a kernel is made: a node loads its kernels in a thread beside the one that asks."""


class Part:
    """A function that kernels call, and that is compiled with them; Python does not call it.

    Attributes
    ----------
    function : function
        The function in Python.
    name : str
        Its name.
    """

    def __init__(self, function: Callable[..., Any]) -> None:
        self.function = cast("FunctionType", function)
        self.name = self.function.__name__


class Kernel(Part):
    """A kernel that Python calls.

    Only what is called is compiled, so a variant waits for its own kernels and no others. Once
    compiled it is kept on disk (`kernel_store`), and a later process links it without numba
    (`linking`).

    Parameters
    ----------
    function : callable
        The kernel in Python.
    signature : str
        Its types in numba's words.
    """

    def __init__(self, function: Callable[..., Any], signature: str) -> None:
        super().__init__(function)
        self._signature = signature
        self._ready: Callable[..., Any] | None = None
        functools.update_wrapper(self, function)

    def __call__(self, *arguments: Any) -> Any:
        """Call the compiled function."""
        ready = self._ready
        if ready is None:
            ready = self.prepare()
        return ready(*arguments)

    @property
    def is_ready(self) -> bool:
        """True once the kernel is compiled or loaded."""
        return self._ready is not None

    def prepare(self) -> Callable[..., Any]:
        """Load the compiled function, or compile it, and return it."""
        with _making:
            if self._ready is None:
                self._ready = self._loaded() or self._compiled()
            return self._ready

    @property
    def source(self) -> str:
        """All that the compiled code follows from: modules' texts, numbers, and the types."""
        texts = [self._signature]
        for module in sorted(_modules_of(self.function, set())):
            texts.append(inspect.getsource(sys.modules[module]))
            # Compiled code has the values of other modules' constants for good.
            texts += [
                f"{name}={value!r}"
                for name, value in vars(sys.modules[module]).items()
                if isinstance(value, (int, float))
            ]
        return "\n".join(texts)

    def _loaded(self) -> Callable[..., Any] | None:
        """Link what was compiled before; None where there is nothing, or nothing that fits."""
        code = _room("kernel_store").read(self.function.__module__, self.name, self.source)
        if code is None:
            return None
        linking = _room("linking")
        try:
            linked: Callable[..., Any] = linking.linked(code, self.name)
        except linking.LinkError as error:
            _note(NOT_LINKED, error)
            return None
        return self._checked_at_first(linked, code.arrays)

    def _checked_at_first(
        self, linked: Callable[..., Any], arrays: Sequence[ArrayForm]
    ) -> Callable[..., Any]:
        """Check what the first calls give; then call the linked function without it."""
        calls = itertools.count(1)

        def checked(*arguments: Any) -> Any:
            check(arrays, arguments)
            if next(calls) == _CHECKED_CALLS:
                self._ready = linked
            return linked(*arguments)

        return checked

    def _compiled(self) -> Callable[..., Any]:
        """Compile it, and keep its object code."""
        compilation = _room("compilation")
        compiled: Callable[..., Any] = compilation.compiled_by_numba(
            self.function, self._signature, lambda value: isinstance(value, Part)
        )
        # Then it is Python as before: there is nothing to keep.
        if compilation.is_disabled():
            return compiled
        try:
            code = compilation.object_code(compiled)
        except compilation.OtherNumbaError as error:
            _note(NOT_LINKED, error)
            return compiled
        try:
            _room("kernel_store").write(self.function.__module__, self.name, self.source, code)
        except OSError as error:
            _note(NOT_KEPT, error)
        return compiled


def compiled(result: str, *arguments: str) -> Callable[[FunctionT], FunctionT]:
    """Make a kernel of a function whose result and arguments have these types."""

    def make(function: FunctionT) -> FunctionT:
        return cast("FunctionT", Kernel(function, f"{result}({', '.join(arguments)})"))

    return make


def inlined(function: FunctionT) -> FunctionT:
    """Make a part of the kernels that call this function; Python cannot call it."""
    return cast("FunctionT", Part(function))


def kernels_of(module: ModuleType) -> Iterator[Kernel]:
    """List the kernels that a module defines."""
    for value in vars(module).values():
        if isinstance(value, Kernel) and value.function.__module__ == module.__name__:
            yield value


def notices() -> Sequence[str]:
    """Return the problems met while compiling, one sentence each; later ones join them."""
    return _notices


def _note(trouble: str, error: Exception) -> None:
    """Note a problem once: all kernels have the same folder and numba, and so the same trouble."""
    if not _notices:
        _notices.append(trouble.format(str(error).partition("\n")[0]))


def _modules_of(function: FunctionType, seen: set[str]) -> set[str]:
    """Name the modules of a function and of the parts that its module has."""
    if function.__module__ not in seen:
        seen.add(function.__module__)
        for value in vars(sys.modules[function.__module__]).values():
            if isinstance(value, Part):
                _modules_of(value.function, seen)
    return seen


def _room(module: str) -> ModuleType:
    """Import a module that needs LLVM or numba, which may be absent, or slow to come."""
    return importlib.import_module(f"{__package__}.{module}")
