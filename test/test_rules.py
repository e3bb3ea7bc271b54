# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The rules of form, read from the source: where numbers stand, how long and large things are."""

import ast
import re
from collections import Counter
from pathlib import Path

import pytest
from source_modules import SOURCE, Module, made_up, own_modules

from tools.licence_headers import HEADER

FILES = sorted(SOURCE.rglob("*.py"))
MAX_FILE_LINES = 350
MAX_FUNCTION_LINES = 60
MOST_FIELDS = 12
"""Fields of a class that a reader keeps in mind."""
TABLES = re.compile(r"Parameters$|Request$|Options?$|^Metrics$|^Estimate$")
"""Classes that are tables: of parameters, of options of a command, of results by name."""
ROW = re.compile(r"^(share|parameter|\w+_parameter|option|positional|switch|group)$")
"""Calls that are a row of a table of parameters, laid out by hand."""
VAGUE = {
    "APART", "FAR", "FARTHEST", "FEW", "FEWEST", "HALF", "LEAST", "LITTLE", "MOST", "NEARLY",
    "SETTLED_AFTER",
}  # fmt: skip
"""Words that name no decision."""
VAGUE_ELSEWHERE = {
    *VAGUE, "CELL", "CELLS", "DOUBT", "ENTRY", "EVEN", "EXIT", "FRAME", "MAX_DIFF", "MAX_SIDE",
    "MODELS", "NOTHING", "START", "TABLE",
}  # fmt: skip
"""Words that name a decision in its own module only, not where it is imported."""
MOST_TUPLES = 66
"""Tuples assigned to as many names without need; the number may only become smaller."""


def is_number(node: ast.expr | None) -> bool:
    return isinstance(node, ast.Constant) and type(node.value) in (int, float)


def late_numbers(tree: ast.Module) -> list[str]:
    """Name the numeric constants that stand below a definition."""
    names, seen = [], False
    for node in tree.body:
        seen |= isinstance(node, ast.FunctionDef | ast.ClassDef)
        if isinstance(node, ast.Assign | ast.AnnAssign) and seen and is_number(node.value):
            target = node.targets[0] if isinstance(node, ast.Assign) else node.target
            names += [target.id] if isinstance(target, ast.Name) else []
    return names


def fields_of(node: ast.ClassDef) -> set[str]:
    """Name what a class declares, and what its methods bind on `self`."""
    declared = {
        statement.target.id
        for statement in node.body
        if isinstance(statement, ast.AnnAssign) and isinstance(statement.target, ast.Name)
    }
    bound = {
        part.attr
        for part in ast.walk(node)
        if isinstance(part, ast.Attribute)
        and isinstance(part.ctx, ast.Store)
        and isinstance(part.value, ast.Name)
        and part.value.id == "self"
    }
    return declared | bound


def large_classes(tree: ast.Module) -> list[str]:
    return [
        f"{node.name}: {len(fields_of(node))}"
        for node in ast.walk(tree)
        if isinstance(node, ast.ClassDef)
        and not TABLES.search(node.name)
        and len(fields_of(node)) > MOST_FIELDS
    ]


def is_row(value: ast.expr | None) -> bool:
    """Return whether a value declares a parameter or an option, or a kind of them."""
    if not isinstance(value, ast.Call):
        return False
    if ast.unparse(value.func) == "functools.partial":
        value = ast.Call(value.args[0], [], [])
    return bool(ROW.match(ast.unparse(value.func)))


def is_table(value: ast.expr | None) -> bool:
    """Return whether every entry of a value is a row: a call of one class, or a tuple by name."""
    if isinstance(value, ast.Call) and ast.unparse(value.func) == "MappingProxyType":
        value = value.args[0]
    if isinstance(value, ast.Dict):
        rows = value.values
        if all(isinstance(row, ast.Tuple) for row in rows):
            return None not in value.keys
    elif isinstance(value, ast.Tuple):
        rows = value.elts
    else:
        return False
    called = {ast.unparse(row.func) if isinstance(row, ast.Call) else None for row in rows}
    return len(called) == 1 and None not in called


def needless_tuples(tree: ast.Module) -> int:
    """Count the assignments of a tuple to names none of which it reads: two statements in one."""
    return sum(
        isinstance(node, ast.Assign)
        and isinstance(node.targets[0], ast.Tuple)
        and isinstance(node.value, ast.Tuple)
        and not names_in(node.targets[0]) & names_in(node.value)
        for node in ast.walk(tree)
    )


def names_in(node: ast.expr) -> set[str]:
    return {part.id for part in ast.walk(node) if isinstance(part, ast.Name)}


def skips_outside_tables(text: str) -> list[int]:
    """Give the lines at which the formatter is told to keep off what is no table."""
    tree = ast.parse(text)
    kept = {
        node.end_lineno
        for node in ast.walk(tree)
        if isinstance(node, ast.Assign | ast.AnnAssign)
        and (is_row(node.value) or (node in tree.body and is_table(node.value)))
    }
    lines = text.splitlines()
    return [at for at, line in enumerate(lines, 1) if "fmt: skip" in line and at not in kept]


def too_long(modules: dict[str, Module]) -> list[str]:
    rows = []
    for module in modules.values():
        lines = module.path.read_text(encoding="utf-8").removeprefix(HEADER).count("\n")
        if lines > MAX_FILE_LINES:
            rows.append(f"{module.path.name} ({module.name}): {lines} lines")
        for node in ast.walk(module.tree):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                length = (node.end_lineno or node.lineno) - node.lineno + 1
                if length > MAX_FUNCTION_LINES:
                    rows.append(f"{module.at(node.lineno)} {node.name}: {length} lines")
    return rows


@pytest.fixture(scope="module")
def trees():
    return {module.path: module.tree for module in own_modules().values()}


def test_no_number_stands_below_a_definition(trees):
    found = {path.name: names for path, tree in trees.items() if (names := late_numbers(tree))}
    assert not found


def test_classes_have_twelve_fields_at_most(trees):
    assert sorted(name for tree in trees.values() for name in large_classes(tree)) == []


def test_only_tables_keep_the_formatter_off():
    found = {
        path.name: lines
        for path in FILES
        if (lines := skips_outside_tables(path.read_text(encoding="utf-8")))
    }
    assert not found


def test_no_constant_is_named_by_a_word_that_names_no_decision(trees):
    found = {
        f"{path.name}: {target.id}"
        for path, tree in trees.items()
        for node in tree.body
        if isinstance(node, ast.Assign)
        for target in node.targets
        if isinstance(target, ast.Name) and target.id.lstrip("_") in VAGUE
    }
    assert not found


def test_no_constant_is_imported_by_a_word_that_tells_nothing_elsewhere(trees):
    found = {
        f"{path.name}: {alias.name}"
        for path, tree in trees.items()
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
        if alias.name in VAGUE_ELSEWHERE
    }
    assert not found


def test_no_more_tuples_are_assigned_than_were(trees):
    assert sum(map(needless_tuples, trees.values())) <= MOST_TUPLES


def test_what_breaks_a_rule_is_found():
    tree = ast.parse("def f(): pass\nEARLY: int = 3\n_LATE = 0.5\nNAMES = ()\n")
    assert late_numbers(tree) == ["EARLY", "_LATE"]
    assert late_numbers(ast.parse("A = 1\nclass B: pass\n")) == []
    fields = "\n".join(f"    a{number}: int" for number in range(12))
    assert large_classes(ast.parse(f"class A:\n{fields}\n")) == []
    method = "    def f(self):\n        self.b = 1\n"
    assert large_classes(ast.parse(f"class A:\n{fields}\n{method}")) == ["A: 13"]
    assert large_classes(ast.parse(f"class AParameters:\n{fields}\n{method}")) == []
    assert needless_tuples(ast.parse("a, b = 1, 2\nc.d, e = 3, f\n")) == 2
    assert needless_tuples(ast.parse("a, b = b, a\nc, d = f(1)\ne = 1, 2\n")) == 0
    row = "class P:\n    a: int = parameter(\n        1,\n    )  # fmt: skip\n"
    assert skips_outside_tables(row) == []
    kind = "low = functools.partial(\n    parameter, 1,\n)  # fmt: skip\n"
    assert skips_outside_tables(kind) == []
    table = "TABLE = (\n    Row(1),\n    Row(2),\n)  # fmt: skip\n"
    assert skips_outside_tables(table) == []
    assert skips_outside_tables("TABLE = {\n    'a': (1, 2),\n}  # fmt: skip\n") == []
    assert skips_outside_tables("NAMES = (\n    'a', 'b',\n)  # fmt: skip\n") == [3]
    assert skips_outside_tables("POINTS = [\n    (1, 2),\n]  # fmt: skip\n") == [3]
    assert skips_outside_tables("def f():\n    a = (\n    Row(1),\n    )  # fmt: skip\n") == [4]
    assert skips_outside_tables("def f(\n    a,\n):  # fmt: skip\n    pass\n") == [3]


def unnamed_modules(package: Path) -> list[str]:
    """Name the modules and packages in `package` whose names its docstring does not have."""
    words = ast.get_docstring(ast.parse((package / "__init__.py").read_text(encoding="utf-8")))
    known = set(re.findall(r"\w+", words or ""))
    # Verbs of the command line have their names from what a user types.
    modules = [path.stem for path in package.glob("*.py") if not defines_request(path)]
    packages = [path.parent.name for path in package.glob("*/__init__.py")]
    return sorted({*modules, *packages} - known - {"__init__", "__main__"})


def defines_request(path: Path) -> bool:
    tree = ast.parse(path.read_text(encoding="utf-8"))
    classes = {node.name for node in tree.body if isinstance(node, ast.ClassDef)}
    others = {name for node in tree.body if isinstance(node, ast.Assign) for name in names_in(node)}
    return "Request" in classes | others


def test_each_folder_says_what_lies_where_in_it():
    packages = [path.parent for path in SOURCE.rglob("__init__.py") if path.parent != SOURCE]
    assert len(packages) > 30
    unnamed = {str(each.relative_to(SOURCE)): unnamed_modules(each) for each in packages}
    assert not {package: names for package, names in unnamed.items() if names}


def test_a_module_that_its_folder_does_not_name_is_found(tmp_path):
    (tmp_path / "__init__.py").write_text('"""A folder: `named` does it."""\n')
    (tmp_path / "named.py").write_text("")
    (tmp_path / "forgotten.py").write_text("")
    (tmp_path / "verb.py").write_text("class Request: ...\n")
    assert unnamed_modules(tmp_path) == ["forgotten"]


def absent_constants(texts: dict[str, list[str]]) -> list[str]:
    """Name constants in backticks that no module has: `_NAME` in its own, `module._NAME` there."""
    absent = []
    for module, own in texts.items():
        words = {name: text.replace(f"`{name}`", "") for text in own for name in quoted(text)}
        for name, rest in words.items():
            home, _, constant = name.rpartition(".")
            known = texts.get(home, []) if home else [rest]
            if not any(re.search(rf"\b{constant}\b", text) for text in known):
                absent.append(f"{module}: {name}")
    return sorted(absent)


def quoted(text: str) -> set[str]:
    return set(re.findall(r"`((?:[a-z_]+\.)?_[A-Z][A-Z_]+)`", text))


def test_constants_that_are_referred_to_exist():
    texts: dict[str, list[str]] = {}
    for path in FILES:
        texts.setdefault(path.stem, []).append(path.read_text(encoding="utf-8"))
    assert not absent_constants(texts)


def test_a_constant_that_is_gone_is_found():
    texts = {"one": ["`_HERE` `two._THERE` `two._GONE` `_MOVED`\n_HERE = 1"], "two": ["_THERE = 2"]}
    assert absent_constants(texts) == ["one: _MOVED", "one: two._GONE"]


def test_no_two_modules_of_tests_have_one_name():
    """They stand in no packages: of two, pytest refuses one, and of two samples one is imported."""
    root = Path(__file__).parents[1]
    folders = [root / "test", *root.glob("*/test")]
    counts = Counter(path.name for folder in folders for path in folder.rglob("*.py"))
    del counts["conftest.py"]
    assert [name for name, count in counts.items() if count > 1] == []


def test_files_and_functions_stay_short():
    assert too_long(own_modules()) == []


def test_checker_measures_files_and_functions(tmp_path):
    body = "    pass\n"
    modules = made_up(
        tmp_path,
        ros__long="x = 1\n" * 351,
        ros__full="x = 1\n" * 350,
        ros__function="def f():\n" + body * 60,
        ros__fitting="class C:\n async def f():\n" + "  pass\n" * 59,
    )
    assert too_long(modules) == [
        "function.py:1 (ros.function) f: 61 lines",
        "long.py (ros.long): 351 lines",
    ]
