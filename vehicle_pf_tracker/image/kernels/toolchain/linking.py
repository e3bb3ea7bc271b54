# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Linking of a kernel's object code into this process, without importing numba.

To import numba, and to make ready what it loads compiled functions with, takes a process more than
a second and 80 MB. Object code needs LLVM's linker (llvmlite), and the functions in C that numba
brings for it, which stand in extension modules of their own.
"""

from __future__ import annotations

import builtins
import ctypes
import functools
import importlib.machinery
import importlib.util
import pickle
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

import llvmlite.binding as llvm
import numpy as np

from vehicle_pf_tracker.image.kernels.toolchain.object_code import ObjectCode


class LinkError(RuntimeError):
    """Object code that cannot be linked here; numba compiles the kernel anew then."""


def linked(compiled: ObjectCode, name: str) -> Callable[..., Any]:
    """Make a Python function of a kernel's object code, which trusts its arguments.

    Parameters
    ----------
    compiled : ObjectCode
        What numba wrote on a machine like this one.
    name : str
        Name of the function.

    Raises
    ------
    LinkError
        If numba's own functions are not those that the code was written for.
    """
    runtime = _runtime()
    # An engine for each: two kernels may have functions of one name, compiled apart.
    engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), runtime.machine())
    # LLVM ends the process at a symbol that it does not find. Asked after the first engine is made,
    # which lets it see the symbols of the process.
    unknown = [symbol for symbol in compiled.symbols if not llvm.address_of_symbol(symbol)]
    if unknown:
        raise LinkError(f"nothing here is called {unknown[0]}")
    engine.add_object_file(llvm.object_file.ObjectFileRef.from_data(compiled.code))
    engine.finalize_object()
    wrapper = engine.get_function_address(compiled.wrapper)
    slot = engine.get_global_value_address(compiled.environment)
    if not wrapper or not slot:
        raise LinkError(f"the object code of {name} lacks its wrapper")
    environment = runtime.functions.Environment({"__name__": __name__})
    environment.consts[:] = [np.dtype(constant) for constant in compiled.constants]
    ctypes.c_void_p.from_address(slot).value = id(environment)
    made: Callable[..., Any] = runtime.functions.make_function(
        sys.modules[__name__], name, f"compiled {name}", wrapper, environment, (engine,)
    )
    _engines.append(engine)
    return made


class _Runtime(NamedTuple):
    """Machine and functions that code is linked with in this process.

    Attributes
    ----------
    machine : callable
        Makes LLVM's description of this machine.
    functions : module
        numba's module in C that makes Python functions.
    """

    machine: Callable[[], Any]
    functions: ModuleType


@functools.cache
def _runtime() -> _Runtime:
    """Make numba's functions in C known to LLVM's linker; once in a process."""
    try:
        functions = _extension("_dynfunc")
        helpers = _extension("_helperlib")
        memory = _extension("core/runtime/_nrt_python")
        # As numba does it when it is imported; arrays are allocated by numpy's own allocator.
        memory.memsys_use_cpython_allocator()
        symbols = {f"numba_{name}": helpers.c_helpers[name] for name in helpers.c_helpers}
        symbols |= {f"numba_{name}": functions.c_helpers[name] for name in functions.c_helpers}
        for name, address in memory.c_helpers.items():
            symbols[name if name.startswith("_") else f"NRT_{name}"] = address
    except Exception as error:  # of another numba, whose modules are not these
        raise LinkError(f"numba's functions in C are not as they were: {error}") from error
    if "numba" not in sys.modules:
        # numba's own imports all of numba for it; one that is imported later puts its own back.
        symbols["numba_unpickle"] = ctypes.cast(_UNPICKLE, ctypes.c_void_p).value
    symbols["_Py_NoneStruct"] = id(None)
    for name, value in vars(builtins).items():
        if isinstance(value, type) and issubclass(value, BaseException):
            symbols[f"PyExc_{name}"] = id(value)
    for name, address in symbols.items():
        llvm.add_symbol(name, address)
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    target = llvm.Target.from_default_triple()
    return _Runtime(functools.partial(target.create_target_machine, jit=True), functions)


def _extension(path: str) -> ModuleType:
    """Load one of numba's modules in C by its path in numba, and none of numba's in Python."""
    spec = importlib.util.find_spec("numba")
    if spec is None or spec.origin is None:
        raise ModuleNotFoundError("No module named 'numba'", name="numba")
    stem = Path(spec.origin).parent / path
    for suffix in importlib.machinery.EXTENSION_SUFFIXES:
        file = stem.with_name(stem.name + suffix)
        if file.is_file():
            loader = importlib.machinery.ExtensionFileLoader(stem.name, str(file))
            made = importlib.util.spec_from_file_location(stem.name, file, loader=loader)
            assert made is not None
            module = importlib.util.module_from_spec(made)
            loader.exec_module(module)
            return module
    raise ImportError(f"there is no {stem}")


_engines: list[Any] = []
"""Owners of the code, kept for good: functions, and addresses below, stay what they are."""
_unpickled: dict[int, Any] = {}
"""Python's objects that compiled code uses, by the address of their pickled bytes in the code:
types of the arrays that it returns, and texts of errors."""


def _unpickled_once(data: int, length: int, _digest: int) -> Any:
    """Return the object of pickled bytes, each time the same one, as numba's `numba_unpickle`."""
    # At each call of a kernel.
    value = _unpickled.get(data)
    if value is None:
        # As trusted as the code that stands beside it in the same file.
        value = _unpickled[data] = pickle.loads(ctypes.string_at(data, length))  # noqa: S301
    return value


_UNPICKLE = ctypes.CFUNCTYPE(ctypes.py_object, ctypes.c_void_p, ctypes.c_int, ctypes.c_void_p)(
    _unpickled_once
)
"""`_unpickled_once` for calls from compiled code, kept for as long as that may call it."""
