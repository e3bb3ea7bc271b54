# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Side products of a run, which may fail without costing the estimates."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, ExitStack, contextmanager, suppress
from typing import Any

from vehicle_pf_tracker.core.errors import InputError


class SideProducts:
    """Record of the pictures, videos and pages of a run that failed, and why."""

    def __init__(self) -> None:
        self._problems: dict[str, str] = {}

    @contextmanager
    def attempt(self, product: str) -> Iterator[None]:
        """Make (a part of) a product; an error is noted, and ends the product only.

        Parameters
        ----------
        product : str
            What is made, in words of a sentence, as ``the video v.mp4``.
        """
        try:
            yield
        except Exception as error:  # OpenCV, PyAV and the disk have no base of their own
            self._problems.setdefault(product, _sentence(product, error))

    @contextmanager
    def growing(
        self, product: str, making: AbstractContextManager[Callable[..., object]]
    ) -> Iterator[Callable[..., None]]:
        """Yield the function that adds to a product, which does nothing once it has failed.

        Parameters
        ----------
        product : str
            What is made, in words of a sentence.
        making : context manager
            Gives the function; completes the product, or discards it if it leaves by an error.
        """
        with ExitStack() as stack:
            function: Callable[..., object] | None = None
            with self.attempt(product):
                function = stack.enter_context(making)

            def add(*values: Any) -> None:
                if function is None or self.failed(product):
                    return
                with self.attempt(product):
                    try:
                        function(*values)
                    except Exception as error:
                        with suppress(Exception):  # the first error is the one that tells why
                            stack.__exit__(type(error), error, None)
                        raise

            yield add
            with self.attempt(product):
                stack.close()

    def failed(self, product: str) -> bool:
        """Return whether making a product has failed."""
        return product in self._problems

    @property
    def notices(self) -> list[str]:
        """Failures so far, a sentence each."""
        return [f"{problem}; all else is written" for problem in self._problems.values()]


def _sentence(product: str, error: Exception) -> str:
    if isinstance(error, InputError):
        return str(error)  # names the thing already
    reason = getattr(error, "strerror", None) or str(error)  # PyAV's are not all OSErrors
    words = " ".join(reason.split())
    return f"cannot make {product}: {words or type(error).__name__}"
