"""A histogram that windows are held against, with what kernels need of it, made once."""

from __future__ import annotations

from functools import cached_property
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

Histogram: TypeAlias = npt.NDArray[np.float64]


class Reference:
    """A normalised histogram and its active bins.

    Only bins that occur in the reference can add to a Bhattacharyya coefficient, so that only those
    are counted in windows. What follows from them is kept, since a reference may serve many frames.

    Parameters
    ----------
    histogram : (bins,) array
        Sums to one, or is all zero and similar to nothing; not changed afterwards.

    Attributes
    ----------
    kept : dict
        What kernels made of it, by a key of their own.
    """

    def __init__(self, histogram: Histogram) -> None:
        self.histogram = np.asarray(histogram, dtype=np.float64)
        self.kept: dict[object, object] = {}

    @cached_property
    def active(self) -> npt.NDArray[np.intp]:
        """Numbers of the bins that are not zero, ascending, shape (K,)."""
        return np.flatnonzero(self.histogram)

    @cached_property
    def values(self) -> Histogram:
        """The histogram at the active bins, shape (K,)."""
        return self.histogram[self.active]
