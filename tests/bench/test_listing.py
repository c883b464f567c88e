"""The docstring of bench lists what is there."""

import re
from pathlib import Path

import bench

ANSWERING = (
    "against_side",
    "gpu_way",
    "glrt_peer",
    "load_side",
    "window_stops_side",
    "window_times_side",
)  # run by other programs
FOLDER = Path(bench.__file__).parent


def listed(title: str) -> list[str]:
    """The names below a title."""
    text = (bench.__doc__ or "").partition(title)[2].partition("\n\n- ")[2].partition("\n\n")[0]
    return re.findall(r"^-? ?(\w+): ", text, re.MULTILINE)


def test_every_module_has_a_line() -> None:
    programs, shared = listed("Programs"), listed("They share")
    assert not {*programs} & {*shared}
    modules = {path.stem for path in FOLDER.glob("*.py")} - {"__init__"}
    assert sorted([*programs, *shared]) == sorted(modules)


def test_programs_are_what_can_be_run() -> None:
    runs = {path.stem for path in FOLDER.glob("*.py") if "__main__" in path.read_text()}
    assert runs - {"__init__"} == {*listed("Programs"), *ANSWERING}
