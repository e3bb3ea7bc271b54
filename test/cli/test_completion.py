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

"""Completion in bash and zsh: what the shells offer, and where the scripts go."""

import shutil
import subprocess
import sys

import pytest

from vehicle_pf_tracker.cli.main import VERBS, main
from vehicle_pf_tracker.scenes.catalogue import SCENES
from vehicle_pf_tracker.trackers.registry import VARIANTS

BASH = """
. {script}
COMP_WORDS=({words}); COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1))
_vehicle_pf_tracker
printf '%s\\n' "${{COMPREPLY[@]}}"
"""
# zsh's own compadd works inside of its editor only; this one offers what that would.
ZSH = """
compadd() {{ shift; print -rl -- ${{(M)@:#${{words[CURRENT]}}*}}; (( $# )) }}
_files() {{ print -r -- FILES }}
words=({words}); CURRENT=${{#words}}
. {script}
"""


@pytest.fixture(scope="module")
def scripts(tmp_path_factory):
    """The scripts as they are printed, by shell."""
    folder, found = tmp_path_factory.mktemp("completion"), {}
    for shell in ("bash", "zsh"):
        code = "import sys; from vehicle_pf_tracker.cli.main import main; sys.exit(main())"
        command = [sys.executable, "-c", code, "--print-completion", shell]
        found[shell] = folder / shell
        found[shell].write_text(subprocess.check_output(command, text=True))
    return found


@pytest.fixture(params=["bash", "zsh"])
def offered(request, scripts):
    """Return what a shell offers for the last of some words."""
    if shutil.which(request.param) is None:
        pytest.skip(f"{request.param} is not installed")
    template = {"bash": BASH, "zsh": ZSH}[request.param]

    def offer(*words):
        quoted = " ".join(f"'{word}'" for word in ("vehicle-pf-tracker", *words))
        text = template.format(script=scripts[request.param], words=quoted)
        options = {"bash": ["--norc"], "zsh": ["-f"]}[request.param]
        done = subprocess.run(
            [request.param, *options, "-c", text], capture_output=True, text=True, check=False
        )
        assert done.stderr == ""
        return set(done.stdout.split())

    return offer


def test_verbs(offered):
    assert offered("") >= {*VERBS, "--help"}
    assert offered("re") == {"report", "replay"}
    assert offered("set-") == {"set-target"}


def test_options_and_their_values(offered):
    assert offered("run", "traffic.mp4", "--va") == {"--variant"}
    assert offered("run", "traffic.mp4", "--variant", "sfpf") == {
        name for name in VARIANTS if name.startswith("sfpf")
    }
    assert offered("evaluate", "rec", "-o", "out", "--variants", "fu") == {"fusion"}
    assert offered("import", "a.mp4", "b", "--format", "") == {"raw", "compressed"}


def test_arguments(offered):
    assert offered("params", "") == set(VARIANTS)
    assert offered("synth", "hi") == {name for name in SCENES if name.startswith("hi")}
    assert offered("road", "cal") == {"calibrate"}


def test_files_are_left_to_the_shell(offered):
    assert offered("run", "traf") <= {"FILES"}
    assert offered("run", "traffic.mp4", "--params", "") <= {"FILES"}


@pytest.mark.parametrize(
    ("shell", "place"),
    [
        ("bash", ".local/share/bash-completion/completions/vehicle-pf-tracker"),
        ("zsh", ".zfunc/_vehicle-pf-tracker"),
    ],
)
def test_it_is_installed_where_the_shell_looks(
    shell, place, scripts, tmp_path, monkeypatch, capsys
):
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.delenv("XDG_DATA_HOME", raising=False)
    monkeypatch.setenv("SHELL", f"/bin/{shell}")
    assert main(["--install-completion"]) == 0
    assert (tmp_path / place).read_text() == scripts[shell].read_text()
    assert f"{tmp_path / place} is written; " in capsys.readouterr().out


@pytest.mark.parametrize("words", [["fish"], ["bash", "zsh"], []])
def test_other_shells_are_told(words, monkeypatch, capsys):
    monkeypatch.setenv("SHELL", "/usr/bin/fish")
    assert main(["--install-completion", *words]) == 2
    assert "say for which shell: --install-completion bash or zsh" in capsys.readouterr().err
