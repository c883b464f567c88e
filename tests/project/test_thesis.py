"""The map of the thesis is true: what stands is accepted, and what is missing is refused."""

import re
import shlex
import tomllib
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from glrt.cli import moving_options, stress
from glrt.cli.commands import parse
from glrt.core.errors import GlrtError
from glrt.image.sources import load_recipe
from glrt.scene.scenefile.toml import parse_scene, scene_to_dict
from tests.support.processes import glrt

PAGE = (Path(__file__).parents[2] / "docs" / "explanation" / "thesis.md").read_text()
CHAPTERS = {"Chapter 1": 15, "Chapter 2": 17, "Chapter 3": 21, "Appendices": 7}  # rows
HEAD = ["thesis", "here", "how", "try", "picture"]
STATES = {"yes", "part", "missing", "none"}
MODEL = "cow.glb"  # a model of the reader
RUN = ("render", "import", "inspect", "doctor")  # others take long, or wait for a user
SMALL = ("--width", "24", "--height", "16")


class Row(NamedTuple):
    """A part of the thesis and its counterpart; `calls` are commands, or keys of a scene file."""

    part: str
    here: str
    calls: list[str]
    picture: str


def rows(chapter: str) -> list[Row]:
    """The rows of the table below a heading."""
    text = re.search(rf"^## {chapter}.*?(?=^## )", PAGE, re.MULTILINE | re.DOTALL)
    assert text, chapter
    lines = [line for line in text[0].splitlines() if line.startswith("|")]
    cells = [[cell.strip() for cell in line[1:-1].split("|")] for line in lines]
    assert cells[0] == HEAD
    found = []
    for line in cells[2:]:
        assert len(line) == len(HEAD), line
        part, here, _, calls, picture = line
        found.append(Row(part, here, re.findall(r"`([^`]+)`", calls), picture))
    return found


ROWS = [row for chapter in CHAPTERS for row in rows(chapter)]
CALLS = {call: row.here for row in ROWS for call in row.calls if call.startswith(("glrt ", "["))}


def words_of(call: str) -> list[str]:
    return shlex.split(call.removeprefix("glrt "))


def refusal(call: str) -> str:
    """Why a command or a key of a scene file is refused; empty if it is not."""
    try:
        _check_key(call) if call.startswith("[") else _check_command(words_of(call))
    except GlrtError as error:
        return str(error)
    return ""


def _check_command(words: list[str]) -> None:
    """Read a command line as far as glrt does before it opens OpenGL."""
    arguments: Any = parse(words)
    if arguments.command == "import":  # its scene is the file that it writes
        return
    named = getattr(arguments, "scenes", None) or [getattr(arguments, "scene", None)]
    for scene in named:
        if scene:
            load_recipe(scene)
    if arguments.command == "chart":
        moving_options.ways_of(arguments)
        moving_options.hysteresis_of(arguments)
    if arguments.command == "stress":
        stress.known_cases(arguments.cases)


def _check_key(text: str) -> None:
    """Read a scene with these keys: `[table] key = value`, or `[table]` alone."""
    scene, _ = load_recipe("methods/two_rooms")
    data = {"probes": {"min": [-1.0] * 3, "max": [1.0] * 3}, **scene_to_dict(scene)}
    for table, keys in tomllib.loads(text.replace("] ", "]\n", 1)).items():
        data[table] = {**data.get(table, {}), **keys}
    parse_scene(data, "scene.toml")


@pytest.mark.parametrize("chapter", CHAPTERS)
def test_every_part_of_a_chapter_has_a_row_that_can_be_tried(chapter: str) -> None:
    found = rows(chapter)
    assert len(found) == CHAPTERS[chapter]
    assert len({row.part for row in found}) == len(found)
    for row in found:
        assert row.here in STATES, row
        assert bool(row.calls) == (row.here != "none"), row


def test_sections_and_appendices_are_all_there() -> None:
    named = {re.split(", ", row.part)[0] for row in ROWS}
    sections = {"1.1", "1.2", "2.1", "2.2", "2.3", "3.1", "3.2", "3.3", "3.4"}
    assert named == sections | set("АБВДЕЄЖ")


@pytest.mark.parametrize("call", CALLS)
def test_what_is_there_is_accepted_and_what_is_missing_is_refused_by_name(call: str) -> None:
    """A row whose word is wrong fails here: change the word to `yes`, `part` or `missing`."""
    found = refusal(call)
    if CALLS[call] == "missing":
        *_, last = re.findall(r"[\w-]+", call.partition("= ")[0].strip())
        assert found, f"{call} works: it is no longer missing"
        assert any(repr(word) in found for word in (last, *call.split()[-2:])), found
    else:
        assert found == "", call


@pytest.mark.slow
@pytest.mark.parametrize(
    "call", [call for call, here in CALLS.items() if here != "missing" and words_of(call)[0] in RUN]
)
def test_every_render_runs(call: str, tmp_path: Path) -> None:
    """At a small size, and few samples where the command does not say how many."""
    words = words_of(call)
    if words[0] == "render":
        words += [*SMALL, *(() if "--samples" in words else ("--samples", "2"))]
    if MODEL in words:
        source = Path(__file__).parents[2] / "scenes" / "models" / MODEL
        (tmp_path / MODEL).write_bytes(source.read_bytes())
    done = glrt(*words, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    if "-o" in words:
        assert (tmp_path / words[words.index("-o") + 1]).stat().st_size > 100
