# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The kernels that measure windows: interface, implementation in OpenCV and numpy, and choice."""

from __future__ import annotations

import functools
import importlib
import importlib.util
from collections.abc import Sequence

import numpy as np

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.correlation import gradient_cells, map_search
from vehicle_pf_tracker.image.correlation.row_waves import RowWaves
from vehicle_pf_tracker.image.motion import box_motion
from vehicle_pf_tracker.image.windows import box_colours, mean_shift
from vehicle_pf_tracker.image.windows.similarity import Histogram, Reference
from vehicle_pf_tracker.image.windows.window import Coefficients, Positions, Window, WindowFeature


class Kernels:
    """Measurement of windows by OpenCV and numpy, which are always available.

    Subclasses do the same faster, and agree on similarities to 1e-6. Each class
    gives the same bits for the same input on one machine. What needs no window is a function of
    another module, bound to the class.

    Parameters
    ----------
    notices : sequence of str
        Problems met while the kernels were loaded, one sentence each.

    Attributes
    ----------
    name : str
        Value of the parameter `kernels` that selects them.
    """

    name = "opencv"

    carried_share = staticmethod(box_motion.carried_share)
    climbed = staticmethod(map_search.climbed)
    count_colours = staticmethod(box_colours.count_colours)
    gradient_cells = staticmethod(gradient_cells.gradient_cells)
    kernel_similarity = staticmethod(mean_shift.kernel_similarity)
    mean_shift = staticmethod(mean_shift.mean_shift)
    row_waves = RowWaves()
    staying = staticmethod(box_motion.staying)

    def __init__(self, notices: Sequence[str] = ()) -> None:
        self.notices = notices

    def similarity(
        self,
        feature: WindowFeature,
        frame: Frame,
        positions: Positions,
        window: Window,
        reference: Reference,
    ) -> Coefficients:
        """Compare windows with a reference.

        Parameters
        ----------
        feature : WindowFeature
            Feature to compare by.
        frame : (H, W, 3) array
            RGB.
        positions : (N, 2) array
            Window centres in px; rounded and kept inside the image as in `window.bounds`.
        window : Window
            Size of all windows; over the border the pixels that exist count.
        reference : Reference
            Histogram of this feature.

        Returns
        -------
        (N,) array
            Bhattacharyya coefficients, 0 to 1.
        """
        # The reference implementation, which every other one has to agree with.
        return feature.similarity(frame, positions, window, reference)

    def histogram(
        self, feature: WindowFeature, frame: Frame, position: tuple[float, float], window: Window
    ) -> Histogram:
        """Describe the window at one position (x, y) in px; all kernels give the same bits.

        Returns
        -------
        (bins,) array
            Sums to one, or all zero where there is nothing to count.
        """
        return np.asarray(feature.histograms(frame, np.asarray([position]), window)[0])


BY_NUMPY = Kernels()
"""Implementation where none is given."""

KERNEL_CHOICES = ("auto", "opencv", "numba")
"""Values of the parameter `kernels`."""


def load_kernels(choice: str) -> Kernels:
    """Make kernels that are ready for use; numba's are compiled when they are first called.

    Parameters
    ----------
    choice : {"auto", "opencv", "numba"}
        `auto` selects numba's where numba can be imported, else OpenCV's.

    Raises
    ------
    InputError
        If numba's are asked for and numba cannot be imported.
    """
    if choice == "opencv":
        return Kernels()
    try:
        # Also for auto: only the attempt tells whether numba can be had.
        return load_numba()
    except Exception as error:  # ImportError, or what a broken installation raises: OSError
        if choice == "numba":
            raise InputError(
                f"kernels: numba needs numba, which cannot be imported ({error}); "
                "install it, or set kernels to auto or opencv"
            ) from error
        # Not installed is a choice; installed and broken is worth a sentence.
        if isinstance(error, ModuleNotFoundError) and error.name == "numba":
            return Kernels()
        why = f"numba is installed but cannot be imported ({error}); the OpenCV kernels are used"
        return Kernels([why])


def compile_all(choice: str) -> Kernels:
    """Make kernels as `load_kernels` does, with every one of them compiled."""
    kernels = load_kernels(choice)
    if kernels.name == "numba":
        importlib.import_module(f"{__package__}.numba_kernels").load_all()
    return kernels


def may_compile(choice: str) -> bool:
    """Tell whether the first use of these kernels links them, or even compiles."""
    # Looked for only: importing numba takes half a second.
    return choice != "opencv" and importlib.util.find_spec("numba") is not None


@functools.cache
def load_numba() -> Kernels:
    """Make numba's kernels; once in a process."""
    # Half a second, for the sentence about one that is absent or broken; where kernels are kept, it
    # has worked.
    if importlib.util.find_spec("numba") is None or not _are_kept():
        importlib.import_module("numba")
    kernels: Kernels = importlib.import_module(f"{__package__}.numba_kernels").NumbaKernels()
    return kernels


def _are_kept() -> bool:
    """Tell whether kernels were compiled before, by this numba for this processor."""
    # Imported late: llvmlite comes with numba.
    kept: bool = importlib.import_module(f"{__package__}.toolchain.kernel_store").has_any()
    return kept
