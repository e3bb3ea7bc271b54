# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Compilation of kernels by numba.

How long it takes follows from what numba writes out for each expression. So kernels fill arrays,
copy them and search them in loops: `a[:] = b` alone takes a second and more, as it brings the
text of an error with it, and `a[:, 0].min()` as long. Arrays are made empty and filled, as zeros
are a function of their own for each type; and `x = a[i, 0]` is shorter than `x, y = a[i]`.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Iterator
from types import FunctionType
from typing import Any

import numba
import numpy as np

from vehicle_pf_tracker.image.kernels.toolchain.arguments import ArrayForm
from vehicle_pf_tracker.image.kernels.toolchain.object_code import ObjectCode
from vehicle_pf_tracker.image.kernels.toolchain.whole_kernels import only_wholes

_FASTMATH = {"reassoc", "contract"}
"""Sums may be reordered, so that loops are vectorised, and products fused into them."""


def compiled_by_numba(
    function: FunctionType, signature: str, is_part: Callable[[Any], bool]
) -> Callable[..., Any]:
    """Compile a function with all that it calls.

    Sums may be reordered (`reassoc`), which is the same in every run of one machine code; nothing
    else of IEEE arithmetic is given up.

    Parameters
    ----------
    function : function
        The kernel in Python.
    signature : str
        Its types in numba's words.
    is_part : callable
        Tells the values of a module that stand for a function to be compiled; each has it as
        ``function``.
    """
    with only_wholes():
        compiled = _compiled(function, signature, is_part)
    # Of a numba that names wrappers otherwise, there is no machine code of the whole either.
    return compiled if _is_whole(compiled) else _compiled(function, signature, is_part)


class OtherNumbaError(RuntimeError):
    """A version of numba from which no object code can be taken."""


def is_disabled() -> bool:
    """Tell whether nothing is to be compiled (NUMBA_DISABLE_JIT), as those ask who seek a fault."""
    return bool(numba.config.DISABLE_JIT)


def object_code(compiled: Any) -> ObjectCode:
    """Return the object code of a compiled function.

    Raises
    ------
    OtherNumbaError
        If numba does not give it as it did.
    """
    try:
        (result,) = compiled.overloads.values()
        arrays = tuple(_arrays_of(result.signature.args))
        library = result.library
        _, _, (code, _) = library.serialize_using_object_code()
        module = library._final_module
        names = result.fndesc
        constants = tuple(np.dtype(constant).str for constant in result.environment.consts)
    except (AttributeError, TypeError, ValueError) as error:
        raise OtherNumbaError(f"numba {numba.__version__}: {error}") from error
    symbols = [function.name for function in module.functions if function.is_declaration]
    called = tuple(name for name in symbols if not name.startswith("llvm."))
    return ObjectCode(
        code, names.llvm_cpython_wrapper_name, names.env_name, constants, arrays, called
    )


def _compiled(
    function: FunctionType, signature: str, is_part: Callable[[Any], bool]
) -> Callable[..., Any]:
    """Compile a function; parameters as for `compiled_by_numba`."""
    copy = _copied(function, is_part, {})
    # No C code calls the kernels, and a wrapper for it takes a twentieth of the compilation.
    compiled: Callable[..., Any] = numba.njit(
        [signature], fastmath=_FASTMATH, no_cfunc_wrapper=True
    )(copy)
    return compiled


def _is_whole(compiled: Any) -> bool:
    """Test whether the wrapper that Python calls has machine code; so has Python itself."""
    results = getattr(compiled, "overloads", {}).values()
    return all(
        result.library.get_pointer_to_function(result.fndesc.llvm_cpython_wrapper_name)
        for result in results
    )


def _arrays_of(arguments: Iterable[numba.types.Type]) -> Iterator[ArrayForm]:
    """List the arrays among arguments of these types."""
    for number, argument in enumerate(arguments):
        is_tuple = isinstance(argument, numba.types.BaseTuple)
        for member, array in enumerate(argument if is_tuple else [argument]):
            if isinstance(array, numba.types.Array):
                dtype = numba.np.numpy_support.as_dtype(array.dtype)
                yield ArrayForm(
                    number,
                    member if is_tuple else None,
                    dtype,
                    array.ndim,
                    array.layout == "C",
                    array.mutable,
                )


def _copied(
    function: FunctionType,
    is_part: Callable[[Any], bool],
    namespaces: dict[str, dict[str, Any]],
) -> FunctionType:
    """Copy a function into a namespace in which what it calls can be compiled with it."""
    module = function.__module__
    if module not in namespaces:
        # Entered before it is filled, as parts call parts of the same module.
        namespace = namespaces[module] = dict(vars(sys.modules[module]))
        build = numba.njit(fastmath=_FASTMATH, no_cpython_wrapper=True, no_cfunc_wrapper=True)
        for name, value in vars(sys.modules[module]).items():
            if is_part(value):
                namespace[name] = build(_copied(value.function, is_part, namespaces))
    copy = FunctionType(
        function.__code__, namespaces[module], function.__name__, function.__defaults__
    )
    # By it numba names what it compiles, and finds the source for its messages.
    copy.__module__ = module
    copy.__qualname__ = function.__qualname__
    return copy
