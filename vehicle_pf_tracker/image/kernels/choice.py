"""Which kernels are used."""

from __future__ import annotations

import functools
import importlib

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.image.kernels.interface import Kernels
from vehicle_pf_tracker.image.kernels.opencv import OpenCvKernels

CHOICES = ("auto", "opencv", "numba")

_NUMBA = "vehicle_pf_tracker.image.kernels.numba_kernels"


def load_kernels(choice: str) -> Kernels:
    """Make kernels ready for use: what has to be compiled, or loaded, is so afterwards.

    Parameters
    ----------
    choice : {"auto", "opencv", "numba"}
        `auto` takes numba's where numba can be imported, else OpenCV's.

    Raises
    ------
    InputError
        If numba's are asked for and numba cannot be imported.
    """
    if choice == "opencv":
        return OpenCvKernels()
    try:
        return _load_numba()
    except ImportError as error:
        if choice == "numba":
            raise InputError(
                f"kernels: numba needs numba, which cannot be imported ({error}); "
                "install it, or set kernels to auto or opencv"
            ) from error
        return OpenCvKernels(_fallback_notices(error))


@functools.cache
def _load_numba() -> Kernels:
    # Imported late: it takes half a second, and only here is it known that somebody wants it.
    made: Kernels = importlib.import_module(_NUMBA).NumbaKernels()
    return made


def _fallback_notices(error: ImportError) -> list[str]:
    """Numba that is not installed is nothing to be told; one that fails to load is."""
    if isinstance(error, ModuleNotFoundError) and error.name == "numba":
        return []
    return [f"numba is installed but cannot be imported ({error}); the OpenCV kernels serve"]
