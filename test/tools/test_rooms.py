# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The graph of the rooms follows the imports."""

from pathlib import Path

from tools.rooms import reduced, rooms_graph

SOURCE = Path(__file__).resolve().parents[2] / "vehicle_pf_tracker"


def made_up(folder, **files):
    for name, text in files.items():
        path = folder.joinpath(*name.split("__")).with_suffix(".py")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return rooms_graph(folder)


def test_an_import_is_an_arrow_between_rooms(tmp_path):
    graph = made_up(
        tmp_path,
        core__box="import numpy",
        image__window="from vehicle_pf_tracker.core.box import Box",
        image__kernels__choice="def f():\n    from vehicle_pf_tracker.image.window import Window",
        ros__node__stream="from vehicle_pf_tracker.core import box",
    )
    assert graph == {
        "core": set(), "image": {"core"}, "image/kernels": {"image"}, "ros": {"core"},
    }  # fmt: skip


def test_a_folder_of_folders_is_no_room(tmp_path):
    (tmp_path / "image").mkdir()
    (tmp_path / "image" / "__init__.py").touch()
    graph = made_up(tmp_path, image__motion__flow="import numpy")
    assert graph == {"image/motion": set()}


def test_an_arrow_that_follows_from_others_is_left_out():
    graph = {"a": {"b", "c"}, "b": {"c"}, "c": set(), "d": {"c"}}
    assert reduced(graph) == {"a": {"b"}, "b": {"c"}, "c": set(), "d": {"c"}}


def test_rooms_that_need_each_other_keep_their_arrows():
    assert reduced({"a": {"b"}, "b": {"a"}}) == {"a": {"b"}, "b": {"a"}}


def test_the_package_has_a_ground_and_a_roof():
    graph = rooms_graph(SOURCE)
    assert graph["core"] == set()
    assert "cli" not in set().union(*graph.values())
    assert "evaluation" in graph["cli"]
    assert reduced(graph)["ros"] == {"following"}
