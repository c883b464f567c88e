"""The docstring of bench lists what is there."""

import importlib
import re
from pathlib import Path

import bench

FOLDER = Path(bench.__file__).parent


def listed(title: str) -> list[str]:
    """The names below a title."""
    text = (bench.__doc__ or "").partition(title)[2].partition("\n\n- ")[2].partition("\n\n")[0]
    return re.findall(r"^-? ?(\w+): ", text, re.MULTILINE)


def test_every_module_has_a_line() -> None:
    programs, shared = listed("Programs"), listed("What they share")
    assert not {*programs} & {*shared}
    modules = {path.stem for path in FOLDER.glob("*.py")} - {"__init__"}
    assert sorted([*programs, *shared]) == sorted(modules)


def test_programs_are_those_that_can_be_run() -> None:
    shared = {name for name in listed("What they share")}
    for name in listed("Programs"):
        assert callable(importlib.import_module(f"bench.{name}").main), name
    text = {name: (FOLDER / f"{name}.py").read_text() for name in shared}
    assert [name for name in shared if "parser_of(" in text[name]] == ["program"]
