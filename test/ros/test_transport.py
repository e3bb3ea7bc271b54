# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import itertools
import socket
import time
from pathlib import Path
from xml.etree import ElementTree

import pytest

from vehicle_pf_tracker.ros import transport
from vehicle_pf_tracker.ros.transport import image_transport, is_free_to_choose, segment_size

MB = 1024 * 1024
FAST_DDS = "rmw_fastrtps_cpp"
SPACE = "{http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles}"


@pytest.mark.parametrize(
    ("image_mb", "free_mb", "size_mb"),
    [
        (0, 1000, 4),  # never less than 4 MB
        (1, 1000, 4),
        (6, 1000, 24),  # four images
        (6, 40, 20),  # half of what is free
        (6, 24, 12),  # two images are the least
        (6, 23, None),
        (0, 4, 2),
        (0, 3, None),
    ],
)
def test_segment_holds_four_images_if_there_is_room(image_mb, free_mb, size_mb):
    expected = None if size_mb is None else size_mb * MB
    assert segment_size(image_mb * MB, free_mb * MB) == expected


def test_profile_is_named_while_it_lasts_and_then_gone():
    environment = {}
    with image_transport(6 * MB, FAST_DDS, environment) as notices:
        (value,) = environment.values()
        path = Path(value)
        root = ElementTree.parse(path).getroot()
    assert notices == []
    assert environment == {}
    assert not path.exists()
    assert not path.parent.exists()
    assert int(root.find(f".//{SPACE}segment_size").text) >= 12 * MB
    used = {item.text for item in root.findall(f".//{SPACE}userTransports/{SPACE}transport_id")}
    kinds = {
        item.find(f"{SPACE}transport_id").text: item.find(f"{SPACE}type").text
        for item in root.iter(f"{SPACE}transport_descriptor")
    }
    assert {kinds[name] for name in used} == {"SHM", "UDPv4"}
    assert root.find(f"{SPACE}participant").attrib["is_default_profile"] == "true"


@pytest.mark.parametrize(
    ("release", "name"),
    [
        ("7.1.6", "FASTRTPS_DEFAULT_PROFILES_FILE"),
        ("9.1.2", "FASTDDS_DEFAULT_PROFILES_FILE"),
        ("unknown", "FASTRTPS_DEFAULT_PROFILES_FILE"),
    ],
)
def test_each_release_reads_its_own_variable(monkeypatch, release, name):
    monkeypatch.setattr(transport, "version", lambda _: release)
    environment = {}
    with image_transport(6 * MB, FAST_DDS, environment):
        assert list(environment) == [name]


def test_profile_goes_also_after_an_error():
    environment = {}
    with pytest.raises(RuntimeError), image_transport(0, FAST_DDS, environment):
        raise RuntimeError
    assert environment == {}


@pytest.mark.parametrize("name", transport.USER_VARIABLES)
def test_a_choice_of_the_user_is_never_overridden(name):
    environment = {name: "their own"}
    with image_transport(6 * MB, FAST_DDS, environment) as notices:
        assert environment == {name: "their own"}
    assert environment == {name: "their own"}
    assert notices == []


@pytest.mark.parametrize("middleware", ["rmw_cyclonedds_cpp", "rmw_zenoh_cpp"])
def test_other_middlewares_are_left_alone(middleware):
    environment = {}
    with image_transport(6 * MB, middleware, environment):
        assert environment == {}


def test_both_kinds_of_fast_dds_are_known():
    assert is_free_to_choose({}, "rmw_fastrtps_cpp")
    assert is_free_to_choose({}, "rmw_fastrtps_dynamic_cpp")


def test_too_little_shared_memory_is_told(monkeypatch):
    monkeypatch.setattr(transport, "SHARED_MEMORY", Path("/nowhere/at/all"))
    environment = {}
    with image_transport(6 * MB, FAST_DDS, environment) as (notice,):
        assert environment == {}
    assert "0.0 MB free" in notice
    assert "6.3 MB" in notice


def test_a_node_announces_itself_often(start_node, ros_domain):
    # Where Fast DDS would announce the tenth participant of the domain on this host.
    port = 7400 + 250 * ros_domain + 10 + 2 * 9
    heard = []
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as peer:
        peer.bind(("127.0.0.1", port))
        peer.settimeout(20)
        start_node("ms")
        # It begins with a burst of 0.1 s; the default is a pause of 3 s after it.
        while not any(gap > 0.5 for gap in _gaps(heard)):
            assert peer.recv(65536).startswith(b"RTPS")
            heard.append(time.monotonic())
    assert max(_gaps(heard)) < 2


def _gaps(times):
    return [after - before for before, after in itertools.pairwise(times)]
