# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Small detection networks in ONNX files, written byte by byte.

They find squares of pure red ("car") and pure blue ("truck") that fill a cell: the mean of a colour
over each cell of 8, 16 and 32 px is its score.
"""

import numpy as np

SIDE = 64
STRIDES = (8, 16, 32)
FLOAT, UINT8, INT64 = 1, 2, 7
TYPES = {np.dtype(np.float32): FLOAT, np.dtype(np.uint8): UINT8, np.dtype(np.int64): INT64}
RED, BLUE = (255, 0, 0), (0, 0, 255)


def varint(value):
    value &= 2**64 - 1
    out = bytearray()
    while value > 127:
        out.append(value & 127 | 128)
        value >>= 7
    return bytes([*out, value])


def field(number, value):
    """Encode one field of a protobuf message: an integer, or bytes."""
    if isinstance(value, int):
        return varint(number << 3) + varint(value)
    value = value.encode() if isinstance(value, str) else value
    return varint(number << 3 | 2) + varint(len(value)) + value


def tensor(name, values):
    dims = b"".join(field(1, side) for side in values.shape)
    return dims + field(2, TYPES[values.dtype]) + field(8, name) + field(9, values.tobytes())


def attribute(name, value):
    head = field(1, name)
    if isinstance(value, int):
        return head + field(3, value) + field(20, 2)
    return head + b"".join(field(8, one) for one in value) + field(20, 7)


def value_info(name, kind, shape):
    dims = b"".join(
        field(1, field(1, side) if isinstance(side, int) else field(2, side)) for side in shape
    )
    return field(1, name) + field(2, field(1, field(1, kind) + field(2, dims)))


class Graph:
    """Graph to which operations are added; each returns the name of its output."""

    def __init__(self):
        self.nodes, self.constants = [], []

    def constant(self, values):
        name = f"c{len(self.constants)}"
        self.constants.append(field(5, tensor(name, np.asarray(values))))
        return name

    def add(self, op, *inputs, output=None, **attributes):
        name = output or f"n{len(self.nodes)}"
        body = b"".join(field(1, one) for one in inputs) + field(2, name) + field(4, op)
        body += b"".join(field(5, attribute(key, value)) for key, value in attributes.items())
        self.nodes.append(field(1, body))
        return name

    def write(self, path, image, outputs, names=None):
        graph = b"".join(self.nodes) + field(2, "test") + b"".join(self.constants)
        graph += field(11, value_info(*image))
        graph += b"".join(field(12, value_info(*output)) for output in outputs)
        model = field(1, 8) + field(8, field(2, 13)) + field(7, graph)
        if names is not None:
            model += field(14, field(1, "names") + field(2, str(dict(enumerate(names)))))
        path.write_bytes(model)
        return path


def cells(side=SIDE):
    """Return left, top and side of every cell, (N, 3)."""
    return np.array(
        [
            (column * stride, row * stride, stride)
            for stride in STRIDES
            for row in range(side // stride)
            for column in range(side // stride)
        ],
        np.float32,
    )


def add_scores(graph, image, channels):
    """Add the mean of the `channels` in each cell: (1, channels, N)."""
    picked = graph.add("Gather", image, graph.constant(np.array(channels)), axis=1)
    flat = graph.constant(np.array([1, len(channels), -1]))
    means = [
        graph.add("AveragePool", picked, kernel_shape=[side, side], strides=[side, side])
        for side in STRIDES
    ]
    return graph.add("Concat", *[graph.add("Reshape", one, flat) for one in means], axis=2)


def yolov8(path, names=("car", "truck"), channels=(0, 2), size=SIDE):
    """RGB from 0 to 1; centre and size in px of the input, then scores: (1, 4 + C, N)."""
    graph, at = Graph(), cells()
    boxes = np.stack([at[:, 0] + at[:, 2] / 2, at[:, 1] + at[:, 2] / 2, at[:, 2], at[:, 2]])
    scores = add_scores(graph, "images", channels)
    graph.add("Concat", graph.constant(boxes[None]), scores, output="output0", axis=1)
    shape = (1, 4 + len(channels), "N")
    return graph.write(
        path, ("images", FLOAT, (1, 3, size, size)), [("output0", FLOAT, shape)], names
    )


def yolov8_anywhere(path, size, side, step, names=("car", "truck")):
    """Network like `yolov8`, of a square of `side` px at any multiple of `step` px.

    The score is the mean of red and of blue in a window, from 0 where half a step is missing.
    """
    graph = Graph()
    picked = graph.add("Gather", "images", graph.constant(np.array([0, 2])), axis=1)
    means = graph.add("AveragePool", picked, kernel_shape=[side, side], strides=[step, step])
    steep = np.float32(2 * side / step)
    scaled = graph.add("Mul", means, graph.constant(np.array(steep)))
    shifted = graph.add("Sub", scaled, graph.constant(np.array(steep - 1)))
    flat = graph.constant(np.array([1, 2, -1]))
    scores = graph.add("Reshape", graph.add("Relu", shifted), flat)
    middles = np.arange(0, size - side + 1, step, dtype=np.float32) + side / 2
    across, down = np.meshgrid(middles, middles)
    sides = np.full(across.size, side, np.float32)
    boxes = np.stack([across.ravel(), down.ravel(), sides, sides])
    graph.add("Concat", graph.constant(boxes[None]), scores, output="output0", axis=1)
    image = ("images", FLOAT, (1, 3, size, size))
    return graph.write(path, image, [("output0", FLOAT, (1, 6, "N"))], names)


def yolox(path, *, relative, names=("car", "truck")):
    """BGR from 0 to 255; centre and size, score of an object, scores: (1, N, 5 + C)."""
    graph, at = Graph(), cells()
    placed = np.stack([at[:, 0] + at[:, 2] / 2, at[:, 1] + at[:, 2] / 2, at[:, 2], at[:, 2]])
    loose = np.stack([np.full(len(at), 0.5), np.full(len(at), 0.5), *np.zeros((2, len(at)))])
    boxes = (loose if relative else placed).astype(np.float32)
    head = np.concatenate([boxes, np.ones((1, len(at)), np.float32)])
    bytes_ = graph.constant(np.array(255, np.float32))
    scores = graph.add("Div", add_scores(graph, "images", (2, 0)), bytes_)
    joined = graph.add("Concat", graph.constant(head[None]), scores, axis=1)
    graph.add("Transpose", joined, output="output", perm=[0, 2, 1])
    image = ("images", FLOAT, (1, 3, SIDE, SIDE))
    return graph.write(path, image, [("output", FLOAT, (1, len(at), 7))], names)


def ssd(path):
    """Bytes (1, height, width, 3); TensorFlow's names, y before x, classes from 1."""
    graph, at = Graph(), cells()
    boxes = np.stack([at[:, 1], at[:, 0], at[:, 1] + at[:, 2], at[:, 0] + at[:, 2]], axis=1) / SIDE
    real = graph.add("Cast", "image", to=FLOAT)
    planes = graph.add("Transpose", real, perm=[0, 3, 1, 2])
    scaled = graph.add("Div", planes, graph.constant(np.array(255, np.float32)))
    both = add_scores(graph, scaled, (0, 2))
    twice = np.concatenate([boxes, boxes])[None].astype(np.float32)
    flat = graph.constant(np.array([1, -1]))
    graph.add("Reshape", both, flat, output="detection_scores")
    graph.add("Identity", graph.constant(twice), output="detection_boxes")
    classes = np.repeat([3.0, 8.0], len(at)).astype(np.float32)[None]
    graph.add("Identity", graph.constant(classes), output="detection_classes")
    count = 2 * len(at)
    return graph.write(
        path,
        ("image", UINT8, (1, "height", "width", 3)),
        [
            ("detection_boxes", FLOAT, (1, count, 4)),
            ("detection_scores", FLOAT, (1, count)),
            ("detection_classes", FLOAT, (1, count)),
        ],
    )


def something_else(path):
    """Return a network that is no detector: the mean colour."""
    graph = Graph()
    graph.add("GlobalAveragePool", "images", output="mean")
    return graph.write(path, ("images", FLOAT, (1, 3, SIDE, SIDE)), [("mean", FLOAT, (1, 3, 1, 1))])
