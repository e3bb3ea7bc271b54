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

"""Completion of the command line in bash and zsh.

A script with all words is written once. Asking the program at each press of the tab key, as
argcomplete does, would load OpenCV and NumPy every time, half a second, and be one more dependency.
"""

from __future__ import annotations

import argparse
import importlib
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path

from vehicle_pf_tracker.cli.console import PROGRAM, UsageError
from vehicle_pf_tracker.cli.requests import add_options
from vehicle_pf_tracker.offline.output_files import make_folder, write_text
from vehicle_pf_tracker.scenes.catalogue import SCENES, TRAFFIC_SCENES
from vehicle_pf_tracker.trackers.registry import VARIANTS

SHELLS = ("bash", "zsh")
INSTALL, PRINT = "--install-completion", "--print-completion"

_NAMES = {"--variant": tuple(VARIANTS), "--variants": tuple(VARIANTS)}
"""Words after options whose parser takes any text."""
_ARGUMENTS = {"params": tuple(VARIANTS), "synth": (*SCENES, *TRAFFIC_SCENES)}
"""Words that are no options, by verb."""


def run(words: Sequence[str], verbs: Mapping[str, tuple[str, str]]) -> int:
    """Install or print the completion, as ``--install-completion [SHELL]`` asks.

    Raises
    ------
    UsageError
        If the shell is none of `SHELLS`, or cannot be told from the environment.
    InputError
        If the script cannot be written.
    """
    action, *rest = words
    shell = rest[0] if rest else Path(os.environ.get("SHELL", "")).name
    if shell not in SHELLS or len(rest) > 1:
        raise UsageError(f"say for which shell: {action} {' or '.join(SHELLS)}")
    text = {"bash": _BASH, "zsh": _ZSH}[shell].format(
        program=PROGRAM,
        function=PROGRAM.replace("-", "_"),
        install=INSTALL,
        cases="\n".join(_cases({name: _actions(module) for name, (module, _) in verbs.items()})),
    )
    if action == PRINT:
        print(text, end="")
        return 0
    path, advice = _place(shell)
    make_folder(path.parent)
    write_text(path, text)
    print(f"{path} is written; {advice}")
    return 0


def _actions(module: str) -> list[argparse.Action]:
    """Return the options and arguments of a verb; none if it needs an extra that is missing."""
    parser = argparse.ArgumentParser()
    with suppress(ModuleNotFoundError):
        add_options(parser, importlib.import_module(f"vehicle_pf_tracker.cli.{module}").Request)
    return list(parser._actions)  # argparse has no other way to list them


def _place(shell: str) -> tuple[Path, str]:
    """Return where a shell looks for the script, and what the user has to do."""
    if shell == "bash":
        data = os.environ.get("XDG_DATA_HOME") or "~/.local/share"
        path = Path(data).expanduser() / "bash-completion" / "completions" / PROGRAM
        return path, f"new shells have it by the package bash-completion, this one by `. {path}`"
    path = Path("~/.zfunc").expanduser() / f"_{PROGRAM}"
    return path, "in ~/.zshrc, before compinit, have `fpath+=~/.zfunc`, and start a new shell"


_BASH = """# Completion of {program}; written by `{program} {install} bash`.
_{function}() {{
    local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} verb= found= i
    for ((i = 1; i < COMP_CWORD; i++)); do
        [[ ${{COMP_WORDS[i]}} == -* ]] || {{ verb=${{COMP_WORDS[i]}}; break; }}
    done
{cases}
    COMPREPLY=($(compgen -W "$found" -- "$word"))
}}
complete -o default -F _{function} {program}
"""

_ZSH = """#compdef {program}
# Completion of {program}; written by `{program} {install} zsh`.
_{function}() {{
    local word=${{words[CURRENT]}} before=${{words[CURRENT-1]}} verb= found= i
    for ((i = 2; i < CURRENT; i++)); do
        [[ ${{words[i]}} == -* ]] || {{ verb=${{words[i]}}; break; }}
    done
{cases}
    compadd -- ${{=found}} || _files
}}
_{function} "$@"
"""


def _cases(verbs: Mapping[str, Iterable[argparse.Action]]) -> Iterator[str]:
    """Write what sets `found` from `verb`, `before` and `word`, in the words that both shells know.

    Options are offered once a dash is there, so that files come first where files are meant.
    """
    yield "    case $verb in"
    yield f'        "") found="{" ".join([*verbs, "--help", "--version", INSTALL, PRINT])}" ;;'
    for verb, actions in verbs.items():
        options: list[str] = []
        arguments = list(_ARGUMENTS.get(verb, ()))
        yield f"        {verb})"
        yield "            case $before in"
        for action in actions:
            options += action.option_strings
            choices = [*map(str, action.choices or ())]
            arguments += [] if action.option_strings else choices
            for name in action.option_strings:
                if known := choices or _NAMES.get(name, ()):
                    yield f'                {name}) found="{" ".join(known)}" ;;'
        yield "                *)"
        yield "                    case $word in"
        yield f'                        -*) found="{" ".join(options)}" ;;'
        yield f'                        *) found="{" ".join(arguments)}" ;;'
        yield "                    esac ;;"
        yield "            esac ;;"
    yield "    esac"
