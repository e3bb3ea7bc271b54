"""What a node has to be told besides its variant's and its stream's parameters."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_pf_tracker.parameters.table import group, parameter


@dataclass(frozen=True, slots=True)
class PublishParameters:
    """Which outputs are published; `~/position`, `~/mode` and `/diagnostics` always are."""

    box: bool = parameter(True, "Publish ~/box; off saves a message per image.")
    velocity: bool = parameter(True, "Publish ~/velocity; off saves a message per image.")
    particles: bool = parameter(True, "Publish ~/particles while somebody subscribes.")
    overlay: bool = parameter(True, "Publish ~/overlay while somebody subscribes.")


@dataclass(frozen=True, slots=True)
class NodeParameters:
    """Transport, start-up and outputs of a node."""

    image_transport: str = parameter(
        "raw",
        "Which images to subscribe to: image, or image/compressed (JPEG or PNG).",
        choices=("raw", "compressed"),
        read_only=True,
    )
    queue_depth: int = parameter(
        1,
        "Images that may wait: 1 always takes the newest of a live camera, 10 and more keeps "
        "every image of a recording.",
        minimum=1,
        maximum=10_000,
        unit="images",
        read_only=True,
    )
    autostart: bool = parameter(
        True,
        "Configure and activate at start-up; off waits for a lifecycle manager.",
        read_only=True,
    )
    publish: PublishParameters = group(PublishParameters)
