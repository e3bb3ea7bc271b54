# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Networks that have a name here: the makers' addresses of detectors for traffic.

None of these files is ours, or comes with this package. The makers publish no sums: those below are
what projects that fetched the files state, several of them independently and alike. A file with
another sum is not taken under a name; as a file or an address of your own it is.
"""

from __future__ import annotations

import importlib.util
from collections.abc import Mapping
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from types import MappingProxyType

_RELEASE = "https://github.com/Megvii-BaseDetection/YOLOX/releases/download/0.1.1rc0"
"""The makers' release that their own list of networks for ONNX names."""
DETECTOR_PACKAGE = "vehicle_pf_detector"
"""A package that an organisation may build of a network, and install from an index of its own."""


@dataclass(frozen=True, slots=True)
class KnownNetwork:
    """A network of others.

    Attributes
    ----------
    url : str
        Address of the makers' file.
    sha256 : str
        Sum of the file there, as others state it.
    bytes : int
        Size of the file, as others state it.
    licence : str
        Licence of the makers' repository; the weights have no other.
    """

    url: str
    sha256: str
    bytes: int
    licence: str

    @property
    def file(self) -> str:
        """Name of the file."""
        return self.url.rpartition("/")[2]

    @property
    def address(self) -> str:
        """Address with the sum that the file must have."""
        return f"{self.url}#sha256={self.sha256}"


KNOWN_NETWORKS: Mapping[str, KnownNetwork] = MappingProxyType({
    "yolox-nano": KnownNetwork(
        f"{_RELEASE}/yolox_nano.onnx",
        "c789161ed43c8269fcd4e67c67eeeb4e80c622da2eb296a20bc6007bd18a0b7d",
        3_659_407, "Apache-2.0",
    ),
    "yolox-tiny": KnownNetwork(
        f"{_RELEASE}/yolox_tiny.onnx",
        "427cc366d34e27ff7a03e2899b5e3671425c262ea2291f88bb942bc1cc70b0f7",
        20_219_662, "Apache-2.0",
    ),
    "yolox-s": KnownNetwork(
        f"{_RELEASE}/yolox_s.onnx",
        "c5c2d13e59ae883e6af3b45daea64af4833a4951c92d116ec270d9ddbe998063",
        35_858_002, "Apache-2.0",
    ),
})  # fmt: skip


def installed(name: str) -> Path | None:
    """Return the file of a network that a package brought; None where there is none."""
    if importlib.util.find_spec(DETECTOR_PACKAGE) is None:
        return None
    file = resources.files(DETECTOR_PACKAGE).joinpath(KNOWN_NETWORKS[name].file)
    path = Path(str(file))
    return path if path.is_file() else None
