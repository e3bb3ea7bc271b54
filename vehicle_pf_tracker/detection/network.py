# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A loaded network, as ONNX Runtime offers it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Protocol

from vehicle_pf_tracker.core.array import Array


class Tensor(Protocol):
    """Input or output of a network, as ONNX Runtime describes it."""

    @property
    def name(self) -> str:
        """Name to run it by."""
        ...

    @property
    def type(self) -> str:
        """Type of its elements, such as ``tensor(float)``."""
        ...

    @property
    def shape(self) -> Sequence[int | str | None]:
        """Its sizes; words and None where they are open."""
        ...


class Network(Protocol):
    """Loaded network: the part of ONNX Runtime's InferenceSession that is used."""

    def get_inputs(self) -> Sequence[Tensor]:
        """Describe the inputs."""
        ...

    def get_outputs(self) -> Sequence[Tensor]:
        """Describe the outputs."""
        ...

    def get_modelmeta(self) -> Any:
        """Return what its author noted; ``custom_metadata_map`` may have names of classes."""
        ...

    def run(self, names: Sequence[str], inputs: Mapping[str, Array]) -> Sequence[Array]:
        """Compute the outputs of these names."""
        ...
