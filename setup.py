"""One description of the package for both of its homes: pip, and colcon on a robot."""

import sys
from pathlib import Path

from setuptools import find_packages, setup

PYTHON = (3, 10)
if sys.version_info < PYTHON:  # before an import fails on what older ones lack
    sys.exit(
        "vehicle_pf_tracker needs Python {}.{} or newer, and this is {}.{}: use the pip of a newer "
        "one".format(*PYTHON, *sys.version_info[:2])
    )

sys.path.insert(0, str(Path(__file__).resolve().parent))  # pip's isolated builds leave it out
from vehicle_pf_tracker.trackers.registry import NODES  # noqa: E402 - needs no library

NAME = "vehicle_pf_tracker"
JAZZY_WHEELS = "sys_platform == 'linux' and platform_machine == 'x86_64'"

RUNTIME = [
    "numpy>=1.26",
    "opencv-python-headless>=4.6",
    "mcap>=1.2",
    "lz4>=4.0",
    "zstandard>=0.19",
    "rosbags>=0.10",
    "rich>=13",
    "PyYAML>=6.0",
]
EVALUATION = ["matplotlib>=3.6", "scipy>=1.11", "jinja2>=3.1"]
TRAFFIC = ["scipy>=1.11"]  # assignment of detections to vehicles
NUMBA = ["numba>=0.60"]
VIDEO = ["av>=14"]
ONNX = ["onnxruntime>=1.17"]
TUNE = ["optuna>=4.0", *EVALUATION]
TEST = ["pytest>=7", "hypothesis>=6.100"]
LINT = ["ruff>=0.17,<0.18", "mypy>=2.4,<3", "types-PyYAML"]
COVERAGE = ["coverage>=7.10"]
READERS = ["evo>=1.30"]  # reads what we write
ROS = [
    f"{wheel}; {JAZZY_WHEELS}"
    for wheel in (
        "ros-jazzy-rclpy[fastrtps]==7.1.6",
        "ros-jazzy-common-interfaces==5.3.6",
        "ros-lifecycle-msgs==2.0.3",
        "ros-rosgraph-msgs==2.0.3",
        "ros-rcl-interfaces==2.0.3",
    )
]

# On a robot (`setup.py install` or `develop`: colcon and the Debian builds) the libraries come from
# apt through package.xml. apt's OpenCV is not called opencv-python-headless, and the executables
# which `setup.py install` writes state requirements that pkg_resources would then find missing.
BUILT_FOR_ROS = not {"install", "develop"}.isdisjoint(sys.argv[1:])


def files(pattern: str) -> list[str]:
    """Files for data_files, which colcon wants relative to the working directory."""
    return sorted(map(str, Path().glob(pattern)))


setup(
    name=NAME,
    version="0.1.0",
    description="Particle-filter vehicle tracking through occlusions, for ROS 2 and recordings",
    license="Apache-2.0",
    maintainer="vehicle_pf_tracker maintainers",
    maintainer_email="maintainers@vehicle-pf-tracker.invalid",
    python_requires=">={}.{}".format(*PYTHON),
    packages=find_packages(include=[NAME, f"{NAME}.*"]),
    package_data={
        NAME: ["py.typed"],
        f"{NAME}.cli": ["pick.html", "pick.js"],
        f"{NAME}.recordings": ["ImageAnnotations.msg"],
        f"{NAME}.evaluation.report": ["templates/*"],
    },
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{NAME}"]),
        (f"share/{NAME}", ["package.xml"]),
        (f"share/{NAME}/config", files("config/*.yaml") + files("config/*.xml")),
        (f"share/{NAME}/launch", files("launch/*.launch.py")),
        (f"share/{NAME}/viewers", files("viewers/*.json") + files("viewers/*.perspective")),
    ],
    zip_safe=False,
    install_requires=[] if BUILT_FOR_ROS else RUNTIME,
    extras_require={
        "ros": ROS,
        "evaluation": EVALUATION,
        "traffic": TRAFFIC,
        "numba": NUMBA,
        "video": VIDEO,
        "onnx": ONNX,
        "tune": TUNE,
        "test": TEST,
        "lint": LINT,
        "dev": TEST + LINT + COVERAGE + TRAFFIC + NUMBA + VIDEO + ONNX + TUNE + READERS,
    },
    entry_points={
        "console_scripts": [
            f"vehicle-pf-tracker = {NAME}.cli.main:main",
            f"bag_replay = {NAME}.cli.main:bag_replay",
            f"video_source = {NAME}.ros.executables:video_source",
            *(f"{one.executable} = {NAME}.ros.executables:main" for one in NODES.values()),
        ],
    },
)
