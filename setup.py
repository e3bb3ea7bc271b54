"""One description of the package for both of its homes: pip, and colcon on a robot.

Name, version, maintainer, licence and addresses stand in package.xml and are read from there.
"""

import sys
import xml.etree.ElementTree as ET
from pathlib import Path

from setuptools import find_packages, setup

PYTHON = (3, 10)
if sys.version_info < PYTHON:  # before an import fails on what older ones lack
    sys.exit(
        "vehicle_pf_tracker needs Python {}.{} or newer, and this is {}.{}: use the pip of a newer "
        "one".format(*PYTHON, *sys.version_info[:2])
    )

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))  # pip's isolated builds leave it out
from vehicle_pf_tracker.trackers.registry import NODES  # noqa: E402 - needs no library

PACKAGE = ET.parse(HERE / "package.xml").getroot()  # noqa: S314 - our own file
NAME = PACKAGE.findtext("name")
MAINTAINER = PACKAGE.find("maintainer")
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
# Many vehicles: the assignment of detections, and detection networks, fetched once.
TRAFFIC = ["scipy>=1.11", "onnxruntime>=1.17", "pooch>=1.8"]
VIDEO = ["av>=14", *TRAFFIC]
EVALUATION = ["matplotlib>=3.6", "jinja2>=3.1", "optuna>=4.0", *VIDEO]
NUMBA = ["numba>=0.60"]
# Several machines: Dask's scheduler and workers, and recordings at URLs.
CLUSTER = ["distributed>=2024.8", "fsspec[http]>=2024.6"]
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
] + VIDEO

# On a robot (`setup.py install` or `develop`: colcon and the Debian builds) the libraries come from
# apt through package.xml. apt's OpenCV is not called opencv-python-headless, and the executables
# which `setup.py install` writes state requirements that pkg_resources would then find missing.
BUILT_FOR_ROS = not {"install", "develop"}.isdisjoint(sys.argv[1:])


def files(pattern: str) -> list[str]:
    """Files for data_files, which colcon wants relative to the working directory."""
    return sorted(map(str, Path().glob(pattern)))


setup(
    name=NAME,
    version=PACKAGE.findtext("version"),
    description="Particle-filter vehicle tracking through occlusions, for ROS 2 and recordings",
    long_description=(HERE / "README.md").read_text(encoding="utf-8"),
    long_description_content_type="text/markdown",
    license=PACKAGE.findtext("license"),
    license_files=["LICENSE"],
    maintainer=MAINTAINER.text,
    maintainer_email=MAINTAINER.get("email"),
    project_urls={url.get("type").capitalize(): url.text for url in PACKAGE.findall("url")},
    keywords=["tracking", "particle filter", "occlusion", "traffic", "vehicles", "video", "ROS 2"],
    classifiers=[
        "Development Status :: 4 - Beta",
        "Environment :: Console",
        "Intended Audience :: Developers",
        "Intended Audience :: Science/Research",
        "Operating System :: POSIX :: Linux",
        "Programming Language :: Python :: 3",
        *(f"Programming Language :: Python :: 3.{minor}" for minor in range(10, 14)),
        "Topic :: Scientific/Engineering :: Image Processing",
        "Topic :: Scientific/Engineering :: Image Recognition",
        "Typing :: Typed",
    ],
    python_requires=">={}.{}".format(*PYTHON),
    packages=find_packages(include=[NAME, f"{NAME}.*"]),
    package_data={
        NAME: ["py.typed"],
        f"{NAME}.cli": ["pick.html", "pick.js"],
        f"{NAME}.showing": ["live.html"],
        f"{NAME}.recordings.bags": ["ImageAnnotations.msg"],
        f"{NAME}.ros": ["transport.xml"],
        f"{NAME}.evaluation": ["baselines.txt"],
        f"{NAME}.image.patches": ["side_network.npz"],
        f"{NAME}.evaluation.report": ["templates/*"],
    },
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{NAME}"]),
        (f"share/{NAME}", ["package.xml"]),
        (f"share/{NAME}/config", files("config/*.yaml") + files("config/*.xml")),
        (f"share/{NAME}/launch", files("launch/*.launch.py")),
        (f"share/{NAME}/viewers", files("viewers/*")),
    ],
    zip_safe=False,
    install_requires=[] if BUILT_FOR_ROS else RUNTIME,
    extras_require={
        "video": VIDEO,
        "ros": ROS,
        "evaluation": EVALUATION,
        "numba": NUMBA,
        "cluster": CLUSTER,
        "test": TEST,
        "lint": LINT,
        "dev": TEST + LINT + COVERAGE + NUMBA + EVALUATION + CLUSTER + READERS,
    },
    entry_points={
        "console_scripts": [
            f"vehicle-pf-tracker = {NAME}.cli.main:main",
            f"bag_replay = {NAME}.cli.main:bag_replay",
            f"video_source = {NAME}.ros.executables:video_source",
            f"vehicle_tracker = {NAME}.ros.executables:main",
            *(f"{one.executable} = {NAME}.ros.executables:main" for one in NODES.values()),
        ],
    },
)
