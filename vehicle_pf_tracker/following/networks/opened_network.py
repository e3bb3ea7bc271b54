# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Network loaded from its file by ONNX Runtime."""

from __future__ import annotations

import importlib
import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.progress import ShowShare, silent
from vehicle_pf_tracker.detection.network import Network, Tensor
from vehicle_pf_tracker.following.networks.model_files import discard, model_file


class OpenedNetwork:
    """A network by ONNX Runtime, loaded from its file or URL.

    A copy, also one in another process, loads it again: the runtime's sessions cannot be copied.

    Parameters
    ----------
    model : str
        The file or URL.
    progress : ShowShare
        Shows how it is fetched.

    Raises
    ------
    InputError
        If ONNX Runtime is not installed, or the file cannot be used.
    """

    def __init__(self, model: str, progress: ShowShare = silent) -> None:
        self._model = model
        self._session = _loaded(model, progress)

    def __reduce__(self) -> tuple[Callable[[str], OpenedNetwork], tuple[str]]:
        """Be copied by what it was loaded from."""
        return open_network, (self._model,)

    def get_inputs(self) -> Sequence[Tensor]:
        """Describe the inputs."""
        return self._session.get_inputs()

    def get_outputs(self) -> Sequence[Tensor]:
        """Describe the outputs."""
        return self._session.get_outputs()

    def get_modelmeta(self) -> Any:
        """Return what its author noted."""
        return self._session.get_modelmeta()

    def run(self, names: Sequence[str], inputs: Mapping[str, Array]) -> Sequence[Array]:
        """Compute the outputs of these names."""
        return self._session.run(names, inputs)


def open_network(model: str, progress: ShowShare = silent) -> OpenedNetwork:
    """Load a network; see `OpenedNetwork`."""
    return OpenedNetwork(model, progress)


def _loaded(model: str, progress: ShowShare) -> Network:
    """Load a network from its file, which is fetched before where it is not here."""
    os.environ.setdefault("ORT_DISABLE_TELEMETRY", "1")  # by default it reports to its makers
    try:
        runtime = importlib.import_module("onnxruntime")
    except ImportError:
        raise InputError(
            "networks need ONNX Runtime: install the extra [video], "
            "pip install 'vehicle_pf_tracker[video]'"
        ) from None
    # After the runtime: without it there is no use in fetching a network.
    path, _ = model_file(model, progress)
    options = runtime.SessionOptions()
    options.log_severity_level = 3  # errors: it warns of every unused weight
    try:
        network: Network = runtime.InferenceSession(
            str(path), options, providers=["CPUExecutionProvider"]
        )
    except Exception as error:  # ONNX Runtime's errors have no base of their own
        # One line of its reason: some of its errors have pages.
        reason = " ".join(str(error).split())[:200]
        kept = discard(model)
        raise InputError(f"the network {model} cannot be loaded: {reason}{kept}") from None
    return network
