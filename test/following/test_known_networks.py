# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Networks by name."""

import hashlib
import re
import sys

import pytest

pytest.importorskip("pooch", reason="the extra [video] is not installed")

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.following.networks import known_networks, model_files
from vehicle_pf_tracker.following.networks.known_networks import KNOWN_NETWORKS, KnownNetwork
from vehicle_pf_tracker.following.networks.model_files import cached, is_fetched, model_file


@pytest.fixture(autouse=True)
def _cache(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setattr(known_networks, "DETECTOR_PACKAGE", "no_such_package")


@pytest.mark.parametrize("name", KNOWN_NETWORKS)
def test_a_name_says_where_from_how_large_and_whose(name):
    network = KNOWN_NETWORKS[name]
    assert network.url.startswith("https://github.com/Megvii-BaseDetection/YOLOX/releases/")
    assert network.file == f"{name.replace('-', '_')}.onnx"
    assert re.fullmatch("[0-9a-f]{64}", network.sha256)
    assert 10**6 < network.bytes < 10**8
    assert network.licence == "Apache-2.0"
    assert is_fetched(name) and not is_fetched(f"{name}.onnx")


def test_offline_the_address_and_the_place_for_the_file_are_said(monkeypatch):
    away = KnownNetwork("http://127.0.0.1:9/yolox_nano.onnx", "0" * 64, 1, "Apache-2.0")
    monkeypatch.setattr(model_files, "KNOWN_NETWORKS", {"yolox-nano": away})
    place = cached(away.url)
    with pytest.raises(InputError) as caught:
        model_file("yolox-nano")
    assert away.url in str(caught.value) and str(place) in str(caught.value)


def test_a_file_put_there_is_taken_if_it_is_the_makers(monkeypatch):
    content = b"\x08 a network"
    away = KnownNetwork("http://127.0.0.1:9/n.onnx", _sum(content), len(content), "Apache-2.0")
    monkeypatch.setattr(model_files, "KNOWN_NETWORKS", {"yolox-nano": away})
    place = cached(away.url)
    place.parent.mkdir(parents=True)
    place.write_bytes(content)
    assert model_file("yolox-nano") == (place, away.sha256)
    place.write_bytes(b"\x08 another")
    with pytest.raises(InputError, match=f"delete {place} to fetch it again"):
        model_file("yolox-nano")


def _sum(content):
    return hashlib.sha256(content).hexdigest()


def test_a_package_of_an_organisation_brings_the_file(tmp_path, monkeypatch):
    folder = tmp_path / "site" / "an_organisations_detector"
    folder.mkdir(parents=True)
    (folder / "__init__.py").touch()
    (folder / "yolox_nano.onnx").write_bytes(b"\x08 a network")
    monkeypatch.syspath_prepend(str(tmp_path / "site"))
    monkeypatch.setattr(known_networks, "DETECTOR_PACKAGE", "an_organisations_detector")
    assert model_file("yolox-nano") == (folder / "yolox_nano.onnx", _sum(b"\x08 a network"))
    sys.modules.pop("an_organisations_detector", None)


@pytest.mark.parametrize(
    ("model", "said"),
    [
        ("yolox-nanno", r"there is no network yolox-nanno \(did you mean 'yolox-nano'\?\); give"),
        ("missing.onnx", "there is no network missing.onnx; give a file, its URL, or one of"),
        ("/", "the network / is not a regular file"),
    ],
)
def test_a_name_that_is_none_is_one_sentence(model, said):
    with pytest.raises(InputError, match=said):
        model_file(model)


def test_without_pooch_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "pooch", None)
    with pytest.raises(InputError, match=r"need pooch: install the extra \[video\]"):
        model_file("yolox-nano")
