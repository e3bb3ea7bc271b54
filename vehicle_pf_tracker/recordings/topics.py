"""Names of the topics in our recordings, and the ROS types that go over them."""

from __future__ import annotations

IMAGE_TOPIC = "/camera/image_raw"
COMPRESSED_TOPIC = "/camera/image_raw/compressed"
TRUTH_POSITION_TOPIC = "/ground_truth/position"
TRUTH_BOX_TOPIC = "/ground_truth/box"
TRUTH_MODE_TOPIC = "/ground_truth/mode"
TRUTH_TOPICS = (TRUTH_POSITION_TOPIC, TRUTH_BOX_TOPIC, TRUTH_MODE_TOPIC)

IMAGE = "sensor_msgs/msg/Image"
COMPRESSED_IMAGE = "sensor_msgs/msg/CompressedImage"
POINT_STAMPED = "geometry_msgs/msg/PointStamped"
POLYGON_STAMPED = "geometry_msgs/msg/PolygonStamped"
DIAGNOSTIC_ARRAY = "diagnostic_msgs/msg/DiagnosticArray"

IMAGE_TYPES = (IMAGE, COMPRESSED_IMAGE)

CAMERA_FRAME = "camera"
"""The `frame_id` of everything in our recordings."""
