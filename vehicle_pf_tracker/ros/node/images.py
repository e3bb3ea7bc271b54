"""Image messages as frames, read in place."""

from __future__ import annotations

from sensor_msgs.msg import CompressedImage, Image

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.compressed_image import decode_compressed
from vehicle_pf_tracker.image.encodings import to_rgb
from vehicle_pf_tracker.ros.node.serialized_image import SerializedImage


def read_image(message: Image | SerializedImage | CompressedImage) -> Frame:
    """Return the RGB frame of `message`; for rgb8 a view of its data.

    Raises
    ------
    InputError
        If the encoding is unknown, or size and data do not fit each other.
    """
    if isinstance(message, CompressedImage):
        return decode_compressed(message.format, message.data)
    return to_rgb(
        message.encoding,
        message.height,
        message.width,
        message.step,
        bool(message.is_bigendian),
        message.data,
    )
