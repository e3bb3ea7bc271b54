# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Damage to files: to the text of a parameter file, and to the bytes of any."""

from __future__ import annotations

import random

# YAML values: of every type, out of all ranges, malformed, and what a loader must not execute.
_VALUES = (
    "0", "-1", "1e400", ".nan", "-.inf", "true", "~", "''", "'1'", "[1, 2.5]", "[]", "{}", "{a: 1}",
    "99999999999999999999", "0x10", "1_000", "!!python/object/apply:os.abort []", "&a [*a]", "wörd",
    "2026-01-01", "'\\0'", "multinomial", "3", "0.25", "|", "- x", "!!binary aGk=", "\x01",
)  # fmt: skip


def spoil_text(text: str, draw: random.Random) -> bytes:
    """Change a YAML file in up to three places."""
    # Without comments: a change in one is no fault.
    lines = [line for line in text.splitlines() if "#" not in line]
    for _ in range(draw.randint(1, 3)):
        index = draw.randrange(len(lines))
        name, colon, _ = lines[index].partition(":")
        lines[index : index + 1] = draw.choice(
            # Another value, a line less, another indent, a letter, lines again, another node.
            [
                [f"{name}{colon} {draw.choice(_VALUES)}"] * draw.randint(1, 2),
                [],
                [" " * draw.randrange(9) + lines[index].lstrip()],
                [lines[index].replace("_", draw.choice("._-/:")) or "..."],
                [lines[index], *lines[: draw.randrange(4)]],
                [draw.choice(("/**:", "apf_tracker:", "---", "\t", "? [x]", "/**/pf_tracker:"))],
            ]
        )
        lines = lines or [""]
    data = "\n".join(lines).encode()
    # At times bytes on top, as of a disk that failed.
    return spoil_bytes(data, draw) if draw.random() < 0.3 else data


def spoil_bytes(data: bytes, draw: random.Random) -> bytes:
    """Overwrite, cut, insert or repeat bytes in up to four places."""
    spoiled = bytearray(data)
    for _ in range(draw.randint(1, 4)):
        place = draw.randrange(len(spoiled) + 1)
        length = draw.choice((1, 2, 8, 64, 1000))
        kind = draw.randrange(5)
        if kind == 0:
            spoiled[place : place + length] = draw.randbytes(length)
        elif kind == 1:
            del spoiled[place : place + length]
        elif kind == 2:
            spoiled[place:place] = draw.choice((b"\0", b"\xff", draw.randbytes(1))) * length
        elif kind == 3:
            # Bytes from earlier in the file, as of a block that was written twice.
            spoiled[place:place] = spoiled[place // 2 : place // 2 + length]
        else:
            del spoiled[draw.choice((place, len(spoiled) - 1, len(spoiled))) :]
    return bytes(spoiled)
