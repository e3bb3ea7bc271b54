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

"""Base of the nodes that take images: parameters, diagnostics, warnings."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from typing import Any

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.ros.messages import stamp_ns
from vehicle_pf_tracker.ros.node.diagnostics import Diagnostics
from vehicle_pf_tracker.ros.node.image_input import ImageInput
from vehicle_pf_tracker.ros.node.managed_node import ManagedNode
from vehicle_pf_tracker.ros.node.parameters import ParameterTable, unknown_overrides
from vehicle_pf_tracker.ros.rclpy_internals import missing


class ImageNode(ManagedNode):
    """Managed node that takes images; active at once unless `autostart` is false.

    A subclass sets what its methods refer to, and then calls `begin`.

    Attributes
    ----------
    table : ParameterTable
        The parameters.
    diagnostics : Diagnostics
        What is published on /diagnostics.
    """

    def begin(self, defaults: Configuration) -> None:
        """Declare the parameters, warn of what is not understood, and start.

        Raises
        ------
        InputError
            If a parameter or a QoS override does not fit; the node is destroyed.
        """
        try:
            self.table = ParameterTable(self, defaults, self._check, self._reconfigure)
            self.diagnostics = Diagnostics(self)
            for loss in missing(self):
                words = f"this release of rclpy is not one of those tried: {loss}"
                self.get_logger().warning(words)
            self.warn_of(unknown_overrides(self, qos=False))
            if self.table.configuration.node.autostart:
                self.start()
        except InputError:
            self.destroy_node()
            raise

    @abstractmethod
    def _check(self, configuration: Configuration) -> None:
        """Refuse parameters that do not fit what the node is doing."""

    @abstractmethod
    def _reconfigure(self, configuration: Configuration) -> None:
        """Take parameters that were changed."""

    @abstractmethod
    def _on_image(self, message: Any, info: Mapping[str, Any]) -> None:
        """Take an image."""

    def open_images(self) -> ImageInput:
        """Listen to images."""
        own = self.table.configuration.node
        source = ImageInput(self, own.image_transport, own.queue_depth, self._on_image)
        self.diagnostics.listen_to(source)
        return source

    def note_arrival(self, message: Any, info: Mapping[str, Any]) -> bool:
        """Note an image; returns False for one taken just before the node was deactivated."""
        if self.diagnostics.source is None:
            return False
        age = self.get_clock().now().nanoseconds - stamp_ns(message.header)
        self.diagnostics.arrived(info, age * 1e-9)
        return True

    def warn_of_overrides(self) -> None:
        """Warn of QoS overrides of topics that the node has not, once all are open."""
        self.warn_of(unknown_overrides(self, qos=True))

    def warn_of(self, sentences: list[str]) -> None:
        """Log what is ignored, a line each."""
        for sentence in sentences:
            self.get_logger().warning(f"ignored: {sentence}")
