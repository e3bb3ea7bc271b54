# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Every command on a page is one that its program takes, and the README's example is run."""

import importlib.util
import re
import shlex
from pathlib import Path

import numpy as np
import pytest

import vehicle_pf_tracker
from vehicle_pf_tracker.cli.main import main, make_parser
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.scenes.catalogue import make_scene
from vehicle_pf_tracker.trackers.registry import NODES

ROOT = Path(__file__).parents[2]
README = ROOT / "README.md"
PAGES = [README, *sorted((ROOT / "docs").glob("*.md"))]
PROGRAM = "vehicle-pf-tracker"
FENCE = re.compile(r"^```(\w*)\n(.*?)^```", re.DOTALL | re.MULTILINE)
INLINE = re.compile(r"(?<!`)`([^`]+)`(?!`)")


def code_lines(text):
    """Yield the lines of shell code: indented or fenced, continued ones joined."""
    fenced = [code for language, code in FENCE.findall(text) if language in {"", "sh"}]
    indented = re.findall(r"^ {4,}\S.*$", FENCE.sub("", text), re.MULTILINE)
    for line in "\n".join([*fenced, *indented]).replace("\\\n", " ").splitlines():
        yield re.sub(r"\s#\s.*", "", line).strip().removesuffix("&").strip()


def mentions(text):
    """Yield the pieces of code within sentences and tables."""
    for code in INLINE.findall(FENCE.sub("", text)):
        yield " ".join(code.split())


def words_of(line):
    """Return a command's words; a shell's variables stand for a word, an ellipsis for none."""
    line = re.sub(r"\$\([^)]*\)|\$\w+", "VALUE", line)
    return [word for word in shlex.split(line) if word != "…"]


def commands(program, lines):
    found = {
        (page.name, line): words_of(line)
        for page in PAGES
        for line in lines(page.read_text(encoding="utf-8"))
        if line.startswith(f"{program} ")
    }
    return [pytest.param(words[1:], id=f"{page}: {line}") for (page, line), words in found.items()]


COMMANDS = commands(PROGRAM, code_lines)
PYTHON = commands("python", code_lines) + commands("python", mentions)
TARGETS = commands("make", code_lines) + commands("make", mentions)
LAUNCHES = commands("ros2 launch vehicle_pf_tracker", code_lines)


@pytest.mark.parametrize("words", COMMANDS)
def test_the_command_is_understood(words):
    assert make_parser(words).parse_args(words).command[1:] == words


@pytest.mark.parametrize("words", commands(PROGRAM, mentions))
def test_the_command_in_a_sentence_is_understood_as_far_as_it_goes(words, capsys):
    try:
        make_parser(words).parse_args(words)
    except SystemExit:
        message = capsys.readouterr().err.splitlines()[-1]
        assert "the following arguments are required" in message or "expected one" in message


def test_there_are_such_commands():
    used = {param.values[0][0] for param in COMMANDS}
    assert used >= {"synth", "import", "evaluate", "tune", "replay", "run", "road"}
    assert len(PYTHON) > 5
    assert len(TARGETS) > 5
    assert len(LAUNCHES) > 1


@pytest.mark.parametrize("words", PYTHON)
def test_the_python_program_is_there_and_has_the_options(words):
    sources = python_sources(words)
    assert sources
    text = "".join(path.read_text(encoding="utf-8") for path in sources)
    for option in (word for word in words if word.startswith("--")):
        name = option[2:].replace("-", "[-_]")  # as a field of a request has it
        assert re.search(rf"\b{name}\b", text), option


def python_sources(words):
    """Return the files of a script, a module, or a package that can be run."""
    if words[0] != "-m":
        return [ROOT / words[0]]
    if words[1] == "pytest":
        return [Path(pytest.__file__).parents[1] / "_pytest" / "main.py"]
    spec = importlib.util.find_spec(words[1])
    if not spec.submodule_search_locations:
        return [Path(spec.origin)]
    files = list(Path(spec.origin).parent.rglob("*.py"))
    return files if any(file.name == "__main__.py" for file in files) else []


@pytest.mark.parametrize("words", TARGETS)
def test_make_knows_the_target(words):
    rules = re.findall(r"^([\w -]+):", (ROOT / "Makefile").read_text(), re.MULTILINE)
    targets = {target for rule in rules for target in rule.split()}
    assert {word for word in words if re.fullmatch(r"[a-z][a-z-]*", word)} <= targets


@pytest.mark.parametrize("words", LAUNCHES)
def test_the_launch_file_declares_what_is_given(words):
    file, *arguments = words[2:]
    text = (ROOT / "launch" / file).read_text()
    if "ARGUMENTS" in text:  # those of tracker.launch.py, shared
        text += (ROOT / "vehicle_pf_tracker" / "ros" / "launching.py").read_text()
    for argument in arguments:
        name = argument.partition(":=")[0]
        assert re.search(rf"""["']{name}["']""", text), name


def test_the_executables_on_pages_are_installed():
    text = "\n".join(page.read_text(encoding="utf-8") for page in PAGES)
    named = set(re.findall(r"ros2 run vehicle_pf_tracker (\w+)", text))
    named |= set(re.findall(r"^\s*(\w+_tracker|video_source|bag_replay) ", text, re.MULTILINE))
    installed = {one.executable for one in NODES.values()}
    installed |= set(re.findall(r'f"([\w-]+) = ', (ROOT / "setup.py").read_text()))
    assert {"fusion_tracker", "video_source"} <= named <= installed


@pytest.mark.slow
def test_the_readme_example_follows_the_vehicle_through_both_occlusions(
    tmp_path, monkeypatch, capsys
):
    (code,) = re.findall(r"```python\n(.*?)```", README.read_text(), re.DOTALL)
    monkeypatch.chdir(tmp_path)
    assert main(["synth", "highway", "traffic.mp4"]) == 0
    capsys.readouterr()
    exec(compile(code, "README.md", "exec"), {})
    lines = capsys.readouterr().out.splitlines()
    truths = list(make_scene("highway").truths())
    assert len(lines) == len(truths)
    modes = [line.split()[0] for line in lines]
    spans = [mode for mode, before in zip(modes, ["", *modes], strict=False) if mode != before]
    assert spans == ["TRACKING", "OCCLUDED", "TRACKING", "OCCLUDED", "TRACKING"]
    last = [float(number) for number in re.findall(r"\(([\d.]+), ([\d.]+)\)", lines[-1])[0]]
    assert np.hypot(*np.subtract(last, truths[-1].box.centre)) < 5


def test_public_names_are_those_listed():
    assert {name: getattr(vehicle_pf_tracker, name) for name in vehicle_pf_tracker.__all__}
    with pytest.raises(AttributeError, match="has no attribute 'nothing'"):
        _ = vehicle_pf_tracker.nothing


@pytest.mark.parametrize(
    ("variant", "parameters", "words"),
    [
        ("fussion", {}, "(did you mean 'fusion'?)"),
        ("apf_tracker", {}, "(did you mean 'apf'?)"),
        ("csrt", {}, "choose one of apf, pf"),
        ("pf", {"num_particle": 3}, "num_particle"),
        ("pf", {"num_particles": 0}, "num_particles must be"),
    ],
)
def test_mistakes_in_making_a_tracker_are_named(variant, parameters, words):
    with pytest.raises(InputError, match=re.escape(words)):
        vehicle_pf_tracker.make_tracker(variant, **parameters)
