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

"""Definitions of the messages that Foxglove draws over images.

They stand in each recording, so that neither writing nor reading one needs the ROS package
foxglove_msgs.
"""

from __future__ import annotations

from types import MappingProxyType

IMAGE_ANNOTATIONS = "foxglove_msgs/msg/ImageAnnotations"

DEFINITIONS = MappingProxyType(
    {
        "foxglove_msgs/msg/Color": "float64 r\nfloat64 g\nfloat64 b\nfloat64 a\n",
        "foxglove_msgs/msg/Point2": "float64 x\nfloat64 y\n",
        "foxglove_msgs/msg/CircleAnnotation": (
            "builtin_interfaces/Time timestamp\n"
            "foxglove_msgs/Point2 position\n"
            "float64 diameter\n"
            "float64 thickness\n"
            "foxglove_msgs/Color fill_color\n"
            "foxglove_msgs/Color outline_color\n"
        ),
        "foxglove_msgs/msg/PointsAnnotation": (
            "builtin_interfaces/Time timestamp\n"
            "uint8 UNKNOWN=0\n"
            "uint8 POINTS=1\n"
            "uint8 LINE_LOOP=2\n"
            "uint8 LINE_STRIP=3\n"
            "uint8 LINE_LIST=4\n"
            "uint8 type\n"
            "foxglove_msgs/Point2[] points\n"
            "foxglove_msgs/Color outline_color\n"
            "foxglove_msgs/Color[] outline_colors\n"
            "foxglove_msgs/Color fill_color\n"
            "float64 thickness\n"
        ),
        "foxglove_msgs/msg/TextAnnotation": (
            "builtin_interfaces/Time timestamp\n"
            "foxglove_msgs/Point2 position\n"
            "string text\n"
            "float64 font_size\n"
            "foxglove_msgs/Color text_color\n"
            "foxglove_msgs/Color background_color\n"
        ),
        IMAGE_ANNOTATIONS: (
            "foxglove_msgs/CircleAnnotation[] circles\n"
            "foxglove_msgs/PointsAnnotation[] points\n"
            "foxglove_msgs/TextAnnotation[] texts\n"
        ),
    }
)
"""Definition by name of the type: the fields of ROS 2 Jazzy's foxglove_msgs."""
