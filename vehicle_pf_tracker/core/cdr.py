# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""CDR, the serialization of ROS 2, as far as the stamp of a header."""

from __future__ import annotations

import struct


def header_stamp_ns(data: bytes | memoryview) -> int | None:
    """Read the stamp of a message in CDR that begins with a header, ns; None if it is too short."""
    # Four bytes of encapsulation, the second of which has the order of the bytes; then the seconds
    # (int32) and the nanoseconds (uint32) of the header.
    if len(data) < 12:
        return None
    seconds, nanoseconds = struct.unpack_from("<iI" if data[1] & 1 else ">iI", data, 4)
    return int(seconds * 1_000_000_000 + nanoseconds)
