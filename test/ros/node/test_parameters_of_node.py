# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Parameters at start-up and at run time, through the node's own services."""

from __future__ import annotations

import math

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.srv import SetParameters, SetParametersAtomically
from rclpy.impl.rcutils_logger import RcutilsLogger
from rclpy.parameter import Parameter
from tracker_rig import SOME_FAST, Rig, diagnostics_of, on_target, overrides, road, values_of

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.configuration import (
    Configuration,
    NodeParameters,
    SessionParameters,
)
from vehicle_pf_tracker.parameters.files import to_yaml
from vehicle_pf_tracker.parameters.table import specs
from vehicle_pf_tracker.ros.node.tracker_node import TrackerNode
from vehicle_pf_tracker.trackers.registry import find_variant

pytestmark = pytest.mark.ros


@pytest.fixture
def make(bench):
    def make(*arguments: str, variant: str = "apf", **values) -> TrackerNode:
        return bench.add(
            TrackerNode(
                find_variant(variant),
                context=bench.context,
                cli_args=["--ros-args", *arguments] if arguments else None,
                parameter_overrides=overrides(**values),
            )
        )

    return make


class LoggedNode:
    """The lines that a node logs, by level."""

    def __init__(self, monkeypatch) -> None:
        self.warnings: list[str] = []
        monkeypatch.setattr(
            RcutilsLogger, "warning", lambda _, words, **__: self.warnings.append(words)
        )


@pytest.fixture
def log(monkeypatch):
    return LoggedNode(monkeypatch)


def yaml_file(tmp_path, *lines: str) -> tuple[str, str]:
    path = tmp_path / "parameters.yaml"
    path.write_text("\n".join(["/**:", "  ros__parameters:", *(f"    {line}" for line in lines)]))
    return "--params-file", str(path)


def value(node: TrackerNode, name: str):
    return node.get_parameter(name).value


# At start-up


@pytest.mark.parametrize("variant", SOME_FAST)
def test_every_parameter_of_the_three_tables_is_declared(make, variant):
    node = make(variant=variant)
    chosen = find_variant(variant).parameters
    tables = [specs(chosen), specs(SessionParameters), specs(NodeParameters)]
    for table in tables:
        for name, spec in table.items():
            assert value(node, name) == spec.default, name
            assert type(value(node, name)) is spec.kind, name
    names = [name for table in tables for name in table]
    assert len(names) == len(set(names))


@pytest.mark.parametrize("variant", SOME_FAST)
def test_descriptors_say_all_that_is_known(make, variant):
    node = make(variant=variant)
    for name, spec in Configuration.of(find_variant(variant)).specs().items():
        told = node.describe_parameter(name)
        assert told.description.startswith(spec.doc)
        assert spec.unit in told.description
        assert spec.source in told.description
        assert told.read_only == spec.read_only
        assert all(word in told.additional_constraints for word in spec.choices)
        ranges = [*told.floating_point_range, *told.integer_range]
        bounds = [(one.from_value, one.to_value) for one in ranges]
        assert bounds == ([spec.bounds] if spec.bounds else [])


def test_whole_numbers_in_a_file_do_for_real_ones(bench, make, tmp_path):
    node = make(*yaml_file(tmp_path, "motion:", "  sigma_w: 4", "lost_after: 3"))
    assert (value(node, "motion.sigma_w"), value(node, "lost_after")) == (4.0, 3.0)
    assert type(value(node, "motion.sigma_w")) is float
    assert node.table.configuration.tracker.motion.sigma_w == 4.0


def test_a_misspelt_key_is_warned_about_by_name(make, tmp_path, log):
    node = make(
        *yaml_file(
            tmp_path,
            "motion.sigma_ww: 4",
            "num_particles: 50",
            "qos_overrides:",
            "  /image_raw.subscription.reliability: reliable",
        )
    )
    assert value(node, "num_particles") == 50
    assert [words for words in log.warnings if "sigma_ww" in words] == [
        "ignored: there is no parameter 'motion.sigma_ww' (did you mean 'motion.sigma_w'?)"
    ]
    assert any("'qos_overrides./image_raw.subscription.reliability'" in w for w in log.warnings)


def test_nothing_is_warned_about_without_need(make, tmp_path, log):
    make(
        *yaml_file(
            tmp_path,
            "use_sim_time: false",
            "qos_overrides:",
            "  /image.subscription.reliability: reliable",
        )
    )
    assert log.warnings == []


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"num_particles": 0}, "num_particles must be from 1 to 100000, got 0"),
        ({"motion__sigma_w": [1.0, 2.0]}, "motion.sigma_w must be a number"),
    ],
)
def test_a_wrong_value_at_start_is_one_sentence(make, values, words):
    with pytest.raises(InputError, match=words.replace("(", r"\(")):
        make(**values)


def test_a_node_that_could_not_start_leaves_nothing_behind(bench, make):
    with pytest.raises(InputError) as caught:
        make(num_particles=0)
    bench.wait_for(lambda: "apf_tracker" not in bench.node.get_node_names())
    assert caught.tb is not None  # which would keep the node alive if nothing destroyed it


def test_qos_can_be_overridden(make):
    node = make(
        *("-p", "qos_overrides./image.subscription.reliability:=reliable"),
        *("-p", "qos_overrides./image.subscription.depth:=7"),
    )
    assert str(node.diagnostics.source) == "/image (raw, reliable, keep last 7)"


def test_what_tuning_writes_is_taken_as_it_is(make, tmp_path, log):
    variant = find_variant("mfpf")
    tuned = Configuration.of(variant).updated(
        {"dispersion.radius": 21.37, "velocity_window": 9, "resampling": "residual"}
    )
    path = tmp_path / "best.yaml"
    path.write_text(to_yaml(tuned.specs(), tuned.to_mapping(), "mfpf: tuned."))
    node = make("--params-file", str(path), variant="mfpf")
    assert {name: value(node, name) for name in tuned.specs()} == tuned.to_mapping()
    assert log.warnings == []


# At run time


def wire(name: str, given) -> ParameterMessage:
    return Parameter(name, value=given).to_parameter_msg()


class Setter:
    def __init__(self, bench, name: str = "/apf_tracker") -> None:
        self.bench, self.name = bench, name

    def one(self, name: str, given):
        request = SetParameters.Request(parameters=[wire(name, given)])
        return self.bench.call(SetParameters, f"{self.name}/set_parameters", request).results[0]

    def together(self, **values):
        request = SetParametersAtomically.Request(
            parameters=[wire(name.replace("__", "."), given) for name, given in values.items()]
        )
        service = f"{self.name}/set_parameters_atomically"
        return self.bench.call(SetParametersAtomically, service, request).result


@pytest.fixture
def rig(bench):
    return Rig(bench, on_target())


@pytest.fixture
def setter(bench, rig):
    return Setter(bench)


def test_a_change_reaches_the_tracker_and_keeps_the_track(rig, setter):
    frames = road(8)
    rig.play(frames[:4])
    assert setter.together(num_particles=40, motion__sigma_w=3).successful
    answer = rig.show_frame(frames[4], 4)
    assert values_of(answer)["num_particles"] == "40"
    assert values_of(answer)["regime"] != "start"
    assert rig.node.table.configuration.tracker.motion.sigma_w == 3.0
    assert rig.play(frames[5:], first=5) == ["TRACKING"] * 3


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"num_particles": 60, "motion__sigma_w": -1.0}, "motion.sigma_w"),
        ({"num_particles": 60, "lost_after": math.nan}, "lost_after"),
        ({"num_particles": 60, "evidence__occluded_below": 0.95}, "must not be above"),
        ({"num_particles": 60, "queue_depth": 5}, "read-only"),
        ({"num_particles": 60, "sigma": 5.0}, "there is no parameter 'sigma'"),
        ({"num_particles": 60, "motion__sigma_w": "wide"}, "Wrong parameter type"),
    ],
)
def test_a_set_is_all_or_nothing_and_says_why(rig, setter, values, words):
    before = rig.node.table.configuration
    result = setter.together(**values)
    assert not result.successful
    assert words in result.reason
    assert value(rig.node, "num_particles") == 200
    assert rig.node.table.configuration is before
    assert rig.show_frame(road(1)[0], 0).status[0].message == "TRACKING"


def test_a_misspelt_name_is_answered_with_the_one_that_is_meant(rig, setter):
    words = "there is no parameter 'num_particels' (did you mean 'num_particles'?)"
    for result in (setter.one("num_particels", 60), setter.together(num_particels=60)):
        assert not result.successful
        assert result.reason == words


def test_values_that_fit_only_together_can_be_set_together(rig, setter):
    assert not setter.one("evidence.occluded_below", 0.85).successful
    assert setter.together(evidence__occluded_below=0.85, evidence__clear_above=0.9).successful


def test_a_drawn_seed_is_told(bench):
    rig = Rig(bench, overrides(seed=-1))
    first = rig.node.feed.facts["seed"]
    assert first >= 0
    told = diagnostics_of(bench, "apf_tracker", lambda table: True)
    assert told["seed"] == str(first)
    assert Setter(bench).together(seed=12).successful
    assert rig.node.feed.facts["seed"] == 12
