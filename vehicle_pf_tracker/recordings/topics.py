# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

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
STAMPED_TYPES = (*IMAGE_TYPES, POINT_STAMPED, POLYGON_STAMPED, DIAGNOSTIC_ARRAY)
"""Types that begin with a header, of those in our recordings."""

CAMERA_FRAME = "camera"
"""The `frame_id` of everything in our recordings."""
