"""Each cell of the table of combinations is tried, whether it works or is refused.

A way to render has a law, such as "a crop is that part of the frame, bit for bit". A cell works if
the law of one holds under the other.
"""

import os
import re
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from glrt.analysis.method_choice import caustics, search
from glrt.cli import caustics as command
from glrt.cli import render
from glrt.cli.commands import run
from glrt.core.errors import UsageError
from glrt.plan.combinations import (
    _REFUSED,
    _UNTRIED,
    _WORKS,
    MEANINGS,
    Way,
    check,
    pairs,
    reason,
    works,
)
from tests.support.lone_crew import alone
from tests.support.ways import OPTIONS, SIZE, Options, merged, plain, relit, save_moving
from tests.support.ways_together import try_together


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """The folder in which commands run; methods are chosen on a frame that is as small.

    This process does the work of `--cluster`.
    """
    monkeypatch.setattr(search, "HEIGHT", 12)
    monkeypatch.setattr(render, "crew_of", alone)
    before = Path.cwd()
    os.chdir(tmp_path)
    yield tmp_path
    os.chdir(before)


WORKING = [pair for pair in pairs() if works(*pair)]
REFUSED = [pair for pair in pairs() if not works(*pair)]


@pytest.mark.slow_cases("a crop-a method with probes", "a method with probes-reuse of points")
@pytest.mark.slow_cases(
    "--resume-AOVs",
    "--resume-a method with probes",
    "--resume-reuse of points",
    "a part of a render-a method with probes",
    "a part of a render-reuse of points",
    "AOVs-light by layers",
    "AOVs-the fragment pipeline",
    "AOVs-a classic lighting model",
    "AOVs-a method with probes",
    "AOVs-reuse of points",
    "light by layers-the independent sampler",
    "light by layers-a classic lighting model",
    "the fragment pipeline-a classic lighting model",
    "a method with probes---denoise",
    "a method with probes---time",
    "reuse of points---denoise",
    "reuse of points---error",
)
@pytest.mark.slow_cases(
    "*--caustics*", "a merged picture-*", "*terms of light*", "*hybrid*", "*method march*"
)
@pytest.mark.slow_cases(
    "*an open shutter",
    "light by layers---*",
    "a classic lighting model---*",
    "the independent*---*",
    "--sampler shared-*",
)
@pytest.mark.slow_cases("*--adaptive on*", "the fragment pipeline---cluster*")
@pytest.mark.slow_cases("an open shutter---cluster*", "AOVs---cluster*")
@pytest.mark.parametrize(
    ("one", "other"),
    [
        pytest.param(*pair, marks=[pytest.mark.slow] if Way.AUTO in pair else [])  # it measures
        for pair in WORKING
    ],
)
def test_a_cell_that_works_works(
    one: Way, other: Way, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A pilot is worth it for renders as short as these, where it is asked for."""
    del folder
    if Way.PILOT in (one, other):
        monkeypatch.setattr(caustics, "LEAST", 0)
        monkeypatch.setattr(command, "SHORT", 0.0)
    try_together(one, other)


# --- refused cells -----------------------------------------------------------------------------

NEVER_ASKED = [  # no command line does
    {Way.LAYERS, Way.MERGED},
    {Way.AUTO, Way.CLASSIC},
    {Way.AUTO, Way.PROBES},
    {Way.CLASSIC, Way.PROBES},
    {Way.AUTO, Way.REUSE},
    {Way.CLASSIC, Way.REUSE},
    *({Way.HYBRID, other} for other in (Way.AUTO, Way.CLASSIC, Way.REUSE)),
    *({Way.MARCH, it} for it in (Way.AUTO, Way.CLASSIC, Way.PROBES, Way.REUSE, Way.HYBRID)),
    {Way.PARTICLES, Way.PILOT},
    {Way.INDEPENDENT, Way.SHARED},
    {Way.LAYERS, Way.SHUTTER},
]


@pytest.fixture
def closed(monkeypatch: pytest.MonkeyPatch) -> Callable[[], None]:
    """Called, it makes every attempt to open OpenGL fail the test."""

    def refuse(*_: object) -> None:
        pytest.fail("OpenGL was opened")

    def close() -> None:
        for module in ("glrt.rendering.renderer", "glrt.cli.caustics"):
            monkeypatch.setattr(f"{module}.open_context", refuse)

    return close


@pytest.mark.parametrize(("one", "other"), REFUSED)
def test_a_cell_that_is_refused_is_refused_before_anything_compiles(
    one: Way, other: Way, folder: Path, closed: Callable[[], None]
) -> None:
    del folder
    if {one, other} in NEVER_ASKED:
        with pytest.raises(UsageError, match="do not go together"):
            check({one, other})
        return
    words = [word for way in (one, other) for word in words_for(way)]
    if words[0] == "--resume" and words[2].endswith(".exr"):
        del words[1]  # it is the other's picture that is to go on
    scene = [] if {one, other} & SOURCES.keys() - {Way.PART} else ["cornell", *SIZE]
    closed()
    with pytest.raises(UsageError, match=re.escape(reason(one, other))):
        run(["render", *scene, *words, "-o", "never.exr"])
    assert not Path("never.exr").exists()


def words_for(way: Way) -> Options:
    """The words that ask for a way; a picture that it takes is made."""
    return SOURCES[way]() if way in SOURCES else OPTIONS[way]


def from_half() -> Options:
    plain(["--samples", "24"]).save("half.exr")
    return ["--resume", "half.exr"]


def from_merged() -> Options:
    merged([])
    return ["merged.exr"]


def from_relit() -> Options:
    relit([])
    return ["relit.exr"]


SOURCES: dict[Way, Callable[[], Options]] = {
    Way.RESUME: from_half,
    Way.PART: lambda: ["--part", "1/3"],
    Way.MERGED: from_merged,
    Way.LAYERS: from_relit,
    Way.SHUTTER: save_moving,
}


# --- the table -----------------------------------------------------------------------------------


def test_every_cell_works_or_has_a_reason() -> None:
    assert [pair for pair in REFUSED if reason(*pair) == _UNTRIED] == []
    assert len(WORKING) + len(REFUSED) == len(Way) * (len(Way) - 1) // 2
    assert set(MEANINGS) == set(Way)


def test_a_cell_does_not_work_and_have_a_reason() -> None:
    assert [pair for pair in WORKING if frozenset(pair) in _REFUSED] == []


def test_what_the_table_does_not_name_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """The default for a new row."""
    table = {**_WORKS, Way.CROP: (), Way.AOV: ()}
    monkeypatch.setattr("glrt.plan.combinations._WORKS", table)
    with pytest.raises(UsageError, match="A crop and AOVs do not go together: nobody has tried"):
        check([Way.AOV, Way.CROP])


@pytest.mark.parametrize("other", [Way.FRAGMENT, Way.LAYERS])
def test_a_refusal_of_hybrid_by_its_probes_names_the_effect_that_needs_them(other: Way) -> None:
    ways = (Way.HYBRID, Way.PROBES, other)
    with pytest.raises(UsageError, match=r"Leave gi out of the effects\.$"):
        check(ways)
    with pytest.raises(UsageError) as refused:
        check(ways[1:])
    assert "effects" not in str(refused.value)


def test_gi_is_to_be_left_out_only_where_that_suffices() -> None:
    """The method hybrid without probes must go with the other option."""
    for way in Way:
        if way in (Way.HYBRID, Way.PROBES) or works(Way.PROBES, way):
            continue
        with pytest.raises(UsageError) as told:
            check({Way.HYBRID, Way.PROBES, way})
        assert ("Leave gi out" in str(told.value)) == works(Way.HYBRID, way), way
