# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Images and targets as cameras, networks and people should not send them, made from a seed."""

from __future__ import annotations

import array
import random
from collections.abc import Callable

from geometry_msgs.msg import Point32, PointStamped, PolygonStamped
from sensor_msgs.msg import Image, RegionOfInterest

from laboratory.faults.drive import FIRST_NS, HEIGHT, PERIOD_NS, WIDTH, header_at
from vehicle_pf_tracker.image.formats.encodings import ENCODINGS
from vehicle_pf_tracker.ros.messages import stamp_ns

DAY_NS = 86_400_000_000_000
"""Leap of a stamp that is a day off, ns."""
_LARGEST = 2**32 - 1
"""Largest uint32, as sizes are in messages."""
# Almost right, other people's, none, and far too long.
_NO_ENCODINGS = (
    "", "rgb", "RGB8", "32FC1", "rgb8; DROP", "x" * 1000, "\u00fc8", "bayer_rggb", "8UC2",
)  # fmt: skip
# Numbers on the edge: none, negative, on a border, overflowing when squared as float32, not finite.
_NUMBERS = (0.0, -1.0, 31.5, 1e30, -1e30, float("nan"), float("inf"), float("-inf"))


class FaultyMessages:
    """Draws faulty images and targets.

    What looks like a real change of the stream, another size or another time, is not drawn twice
    between good images: two that agree are believed, as they have to be.

    Parameters
    ----------
    draw : callable
        Makes the good image of a number, which may be changed.
    seed : int
        Seed of what is drawn.
    """

    def __init__(self, draw: Callable[[int], Image], seed: int) -> None:
        self._draw = draw
        self._random = random.Random(seed)
        self._kinds: list[Callable[[Image], None]] = [
            self._encoding, self._cut, self._no_size, self._huge, self._step, self._pixels,
            self._flat, self._mixed, self._other_size, self._other_time,
        ]  # fmt: skip
        self._looks_real = False

    def image(self, number: int) -> Image:
        """Draw a faulty image that comes between the good ones `number` - 1 and `number`."""
        image = self._draw(number)
        # Between two good images in time, so that its stamp alone is no fault.
        image.header = header_at(stamp_ns(image.header) - PERIOD_NS // 2)
        # The last two kinds of the list look real.
        last = len(self._kinds) - (2 if self._looks_real else 0)
        kind = self._random.randrange(last)
        self._looks_real = self._looks_real or kind >= len(self._kinds) - 2
        self._kinds[kind](image)
        return image

    def note_good(self) -> None:
        """Say that a good image was sent, after which anything may look real."""
        self._looks_real = False

    def target(self) -> RegionOfInterest | PolygonStamped | PointStamped:
        """Draw a target that may be anything, a usable one at times."""
        return self._random.choice([self._region, self._polygon, self._point])()

    def _bytes(self, count: int) -> array.array[int]:
        return array.array("B", self._random.randbytes(count))

    def _encoding(self, image: Image) -> None:
        image.encoding = self._random.choice(_NO_ENCODINGS)

    def _cut(self, image: Image) -> None:
        image.data = self._bytes(self._random.randrange(len(image.data)))

    def _no_size(self, image: Image) -> None:
        image.height = self._random.choice((0, image.height))
        image.width = 0 if image.height else self._random.choice((0, image.width))

    def _huge(self, image: Image) -> None:
        # Sizes whose product overflows 32 bits, or asks for more memory than there is.
        image.height = self._random.choice((image.height, 32_767, _LARGEST))
        image.width = self._random.choice((32_767, 65_535, 2**31, _LARGEST))
        image.step = self._random.choice((image.step, _LARGEST, 3 * image.width % 2**32))

    def _step(self, image: Image) -> None:
        # Around the right one, and where a sum would overflow.
        wrong = (0, 1, image.step - 1, image.step + 1, 2**31, _LARGEST)
        image.step = self._random.choice(wrong)

    def _pixels(self, image: Image) -> None:
        image.data = self._bytes(len(image.data))

    def _flat(self, image: Image) -> None:
        image.data = array.array("B", bytes([self._random.choice((0, 128, 255))]) * len(image.data))

    def _mixed(self, image: Image) -> None:
        draw = self._random
        image.encoding = draw.choice([*ENCODINGS, "", "mono32"])
        image.height = draw.randrange(HEIGHT)
        image.width = draw.randrange(WIDTH)
        image.step = draw.choice((0, image.width, 3 * image.width, 4 * image.width + 5))
        image.is_bigendian = draw.choice((0, 1, 255))
        image.data = self._bytes(draw.choice((0, image.step * image.height, 5, 20_000)))

    def _other_size(self, image: Image) -> None:
        image.height = self._random.randrange(1, HEIGHT)
        image.width = self._random.randrange(1, WIDTH)
        image.step = 3 * image.width
        image.data = self._bytes(image.step * image.height)

    def _other_time(self, image: Image) -> None:
        # The ends of what a stamp can say, a day off, and just before the images.
        now = FIRST_NS
        early = -(2**31) * 10**9
        late = (2**31 - 1) * 10**9
        choices = (0, early, late, now - DAY_NS, now - 1, self._random.randrange(early, now))
        image.header = header_at(self._random.choice(choices))

    def _region(self) -> RegionOfInterest:
        numbers = [self._random.choice((0, 1, 5, 20, 63, 64, 2**31, _LARGEST)) for _ in range(4)]
        return RegionOfInterest(
            x_offset=numbers[0],
            y_offset=numbers[1],
            width=numbers[2],
            height=numbers[3],
            do_rectify=bool(numbers[0] % 2),
        )

    def _number(self) -> float:
        # Three tenths extreme numbers; else points in the image and around it.
        draw = self._random
        return draw.choice(_NUMBERS) if draw.random() < 0.3 else draw.uniform(-20, 80)

    def _polygon(self) -> PolygonStamped:
        # Frames: none, that of the images, and another.
        made = PolygonStamped(header=header_at(0, self._random.choice(("", "camera", "map"))))
        count = self._random.choice((0, 1, 2, 3, 4, 100))
        made.polygon.points = [Point32(x=self._number(), y=self._number()) for _ in range(count)]
        return made

    def _point(self) -> PointStamped:
        made = PointStamped(header=header_at(0, self._random.choice(("", "camera", "map"))))
        made.point.x, made.point.y, made.point.z = (self._number() for _ in range(3))
        return made
