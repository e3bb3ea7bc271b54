# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Serialized messages of other programs, which may be no messages."""

from __future__ import annotations

from typing import TypeVar

from rclpy.serialization import deserialize_message

from vehicle_pf_tracker.core.errors import InputError

MessageT = TypeVar("MessageT")


def read_message(serialized: bytes, kind: type[MessageT]) -> MessageT:
    """Read a message in CDR.

    Raises
    ------
    InputError
        If it is none of this kind. rclpy's own subscriptions pass over such a message; where bytes
        are taken, an exception would count as a failure of the node.
    """
    try:
        message: MessageT = deserialize_message(serialized, kind)
    except RuntimeError:
        raise InputError(
            f"{len(serialized)} bytes came that are not of the type {kind.__name__}: they are cut "
            "off, or of another type"
        ) from None
    return message
