# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Object code of a kernel, in memory and as the bytes of a file."""

from __future__ import annotations

import hashlib
import json
from typing import NamedTuple

from vehicle_pf_tracker.image.kernels.toolchain.arguments import ArrayForm, form_from_json

_SUM_BYTES = hashlib.sha256().digest_size
"""Length of the sum that a file begins with."""


class ObjectCode(NamedTuple):
    """Machine code of a kernel as numba wrote it, and what is needed to call it.

    Attributes
    ----------
    code : bytes
        Object file in the format of this machine.
    wrapper : str
        Symbol of the function that takes and returns Python's objects.
    environment : str
        Symbol of the pointer to numba's environment, which holds `constants`.
    constants : tuple of str
        Types of the arrays that the wrapper returns, as numpy writes them ("<f8").
    arrays : tuple of ArrayForm
        Arrays that it takes, to be checked before the call.
    symbols : tuple of str
        Functions of the C libraries, of Python and of numba that the code calls.
    """

    code: bytes
    wrapper: str
    environment: str
    constants: tuple[str, ...]
    arrays: tuple[ArrayForm, ...]
    symbols: tuple[str, ...]


def to_bytes(compiled: ObjectCode) -> bytes:
    """Write object code as a file: its sum, one line of JSON, and the code."""
    names = {**compiled._asdict(), "code": None}
    body = json.dumps(names, default=lambda dtype: dtype.str).encode() + b"\n" + compiled.code
    return hashlib.sha256(body).digest() + body


def from_bytes(content: bytes) -> ObjectCode | None:
    """Read what `to_bytes` wrote; None for a file that is torn or another's."""
    body = content[_SUM_BYTES:]
    # Code that is called has no second chance: what a full disk cut off never gets there.
    if hashlib.sha256(body).digest() != content[:_SUM_BYTES]:
        return None
    line, _, code = body.partition(b"\n")
    names = json.loads(line)
    return ObjectCode(
        code,
        names["wrapper"],
        names["environment"],
        tuple(names["constants"]),
        tuple(map(form_from_json, names["arrays"])),
        tuple(names["symbols"]),
    )
