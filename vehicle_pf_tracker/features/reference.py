"""A histogram that windows are held against, with what kernels need of it, made once."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

Histogram: TypeAlias = npt.NDArray[np.float64]


class Reference:
    """A normalised histogram and its active bins.

    Only bins that occur in the reference can add to a Bhattacharyya coefficient, so that only those
    are counted in windows. What follows from them is kept, since a reference serves many frames.

    Parameters
    ----------
    histogram : (bins,) array
        Sums to one, or is all zero and similar to nothing; not changed afterwards.

    Attributes
    ----------
    active : (K,) array
        Numbers of the bins that are not zero, ascending.
    values : (K,) array
        The histogram there.
    kept : dict
        What kernels made of it, by a key of their own.
    """

    def __init__(self, histogram: Histogram) -> None:
        self.histogram = np.asarray(histogram, dtype=np.float64)
        self.active = np.flatnonzero(self.histogram)
        self.values: Histogram = self.histogram[self.active]
        self.kept: dict[object, object] = {}
