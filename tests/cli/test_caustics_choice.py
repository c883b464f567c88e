"""`--caustics auto`: a pilot decides, alike for each part, crop, seed and driver, by no clock."""

import json
from argparse import Namespace
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from glrt import merge
from glrt.analysis.method_choice import caustics
from glrt.analysis.method_choice.caustics import BY_PILOT, CHOICES
from glrt.cli import caustics as command
from glrt.cli.commands import run
from glrt.cli.request import Order
from glrt.image.image import Image, read_recipe
from glrt.image.recipe import Recipe
from glrt.image.sources import load
from glrt.rendering.stopping import Limits
from glrt.settings import Settings, settings_for
from tests.support.renders import same
from tests.support.system_packages import needs_osmesa

SIZE = ("--width", "24", "--height", "24", "--bounces", "4")
LONG = (*SIZE, "--samples", "64")  # as much as a pilot, where `folder` has lowered what it takes
BALL, MIRRORS = "methods/caustic", "metals"  # where particles are worth their work, and where not
DECIDED = dict.fromkeys(("caustics", *CHOICES[0]), BY_PILOT)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder in which commands run; a render as short as the pilot is worth it."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(caustics, "LEAST", 1)
    return tmp_path


def rendered(*words: str) -> Image:
    """The picture that `glrt render` makes."""
    assert run(["render", *words, "--quiet", "-o", "out.exr"]) == 0
    return Image.load("out.exr")


def recipe_of(image: Image) -> Recipe:
    assert image.recipe
    return image.recipe


def chosen(image: Image) -> tuple[str, float, float, float]:
    settings = recipe_of(image).settings
    return settings.caustics, settings.particles, settings.aimed, settings.linked


def explicit(image: Image) -> list[str]:
    """The options that ask for what was chosen."""
    names = ("--caustics", *(f"--{name}" for name in CHOICES[0]))
    return [str(word) for pair in zip(names, chosen(image), strict=True) for word in pair]


@pytest.fixture
def no_pilot(monkeypatch: pytest.MonkeyPatch) -> None:
    """A pilot, and the context that it would open, are failures."""

    def fail(*_arguments: object) -> None:
        raise AssertionError("a pilot")

    monkeypatch.setattr(command, "open_context", fail)
    monkeypatch.setattr(caustics, "particles_worth", fail)


# --- what it decides ---------------------------------------------------------------------------


@pytest.mark.slow
def test_a_caustic_gets_particles_and_the_recipe_reports_why(folder: Path) -> None:
    image = rendered(BALL, *LONG)
    assert chosen(image)[0] == "on"
    assert dict(zip(CHOICES[0], chosen(image)[1:], strict=True)) in CHOICES
    assert recipe_of(image).decisions == DECIDED
    assert same(image, rendered(BALL, *LONG, *explicit(image)))
    assert not same(image, rendered(BALL, *LONG, "--caustics", "off"))


@pytest.mark.slow
def test_mirrors_that_light_hardly_comes_by_get_none(folder: Path) -> None:
    image = rendered(MIRRORS, *LONG, "--caustics", "auto")
    assert chosen(image)[0] == "off"
    assert recipe_of(image).decisions == {"caustics": BY_PILOT}
    assert same(image, rendered(MIRRORS, *LONG, "--caustics", "off"))


@pytest.mark.slow
def test_what_is_given_is_kept(folder: Path) -> None:
    image = rendered(BALL, *LONG, "--particles", "0.3")
    assert chosen(image)[:2] == ("on", 0.3)
    assert recipe_of(image).decisions == {name: BY_PILOT for name in DECIDED if name != "particles"}


# --- what it does not depend on ----------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize(
    "words",
    [
        ("--crop", "3", "2", "5", "4"),
        ("--part", "2/4"),
        ("--seed", "7"),
        ("--aov", "depth"),
        ("--exposure", "3", "--tonemap", "aces"),
        ("--time", "1e6"),
        ("--error", "0.01"),
    ],
)
def test_the_pilot_is_the_same_for(words: tuple[str, ...], folder: Path) -> None:
    """For all of these options the message reports the gain of the plain render."""
    told: list[caustics.Finding] = []

    def listened(found: caustics.Finding) -> str:
        told.append(found)
        return ""

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(command, "told", listened)
        for more in ((), words):
            assert run(["render", BALL, *LONG, *more, "-o", "out.exr"]) in (0, 1)
    assert told[0].gain == told[1].gain
    names = ("caustics", *CHOICES[0])
    one, other = ([getattr(found.settings, name) for name in names] for found in told)
    assert one == other


@pytest.mark.slow
def test_egl_and_osmesa_decide_alike(folder: Path) -> None:
    needs_osmesa()
    one, other = (rendered(BALL, *LONG, "--context", route) for route in ("egl", "osmesa"))
    assert recipe_of(one).renderer == recipe_of(other).renderer
    assert chosen(one)[0] == "on"
    assert same(one, other)


@pytest.mark.slow
def test_parts_decide_alike_and_merge(folder: Path) -> None:
    whole = rendered(BALL, *LONG)
    for number in (1, 2):
        rendered(BALL, *LONG, "--part", f"{number}/2").save(f"{number}.exr")
    merged = merge([Image.load("1.exr"), Image.load("2.exr")])
    assert recipe_of(merged).decisions == DECIDED
    np.testing.assert_allclose(merged.radiance, whole.radiance, rtol=1e-5, atol=1e-6)


# --- where there is no pilot -------------------------------------------------------------------


@pytest.mark.parametrize(
    ("scene", "words"),
    [
        (BALL, ("--samples", "32")),
        (BALL, ("--time", "0.2")),
        (BALL, ("--method", "nee")),
        (BALL, ("--method", "phong")),
        (BALL, ("--pipeline", "fragment")),
        (BALL, ("--caustics", "off")),
        (BALL, ("--caustics", "on")),
        ("methods/diffuse", ()),
        ("methods/mesh", ()),
    ],
)
def test_no_pilot_and_no_error(
    scene: str, words: tuple[str, ...], folder: Path, no_pilot: None
) -> None:
    image = rendered(scene, *LONG, *words)
    assert chosen(image)[0] == ("on" if words == ("--caustics", "on") else "off")
    assert recipe_of(image).decisions == {}


def test_an_error_that_few_samples_reach_decides_nothing(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(caustics, "LEAST", 128)
    assert recipe_of(rendered("cornell", *SIZE, "--error", "90%")).decisions == {}


# --- pictures ------------------------------------------------------------------------------------


@pytest.mark.slow
def test_a_picture_keeps_what_was_chosen(folder: Path, request: pytest.FixtureRequest) -> None:
    rendered(BALL, *LONG).save("first.exr")
    rendered(BALL, *SIZE, "--samples", "128").save("whole.exr")
    request.getfixturevalue("no_pilot")
    first, again = Image.load("first.exr"), rendered("first.exr", "--caustics", "auto")
    assert same(again, first)
    assert recipe_of(again).decisions == DECIDED
    longer = rendered("--resume", "first.exr", "--samples", "128")
    assert same(longer, Image.load("whole.exr"))
    assert recipe_of(longer).decisions == DECIDED
    other = rendered("first.exr", "--aimed", "0.7")
    assert {*recipe_of(other).decisions} == {"caustics", "particles", "linked"}


def test_a_picture_without_the_key_has_no_particles(folder: Path, no_pilot: None) -> None:
    rendered(BALL, *LONG, "--caustics", "off").save("off.exr")
    table = json.loads(read_recipe(Path("off.exr")).to_json())
    for name in DECIDED:
        del table["settings"][name]
    assert Recipe.from_json(json.dumps(table), "off.exr").settings.caustics == "off"
    assert chosen(rendered("off.exr"))[0] == "off"


# --- what it reports -----------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.slow_cases("metals-off")
@pytest.mark.parametrize(("scene", "used"), [(BALL, "on"), (MIRRORS, "off")])
def test_it_reports_what_was_chosen(
    scene: str, used: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["render", scene, *LONG, "--json", "-o", "out.exr"]) == 0
    told = capsys.readouterr()
    (line,) = [line for line in told.err.splitlines() if "--caustics" in line]
    assert line.startswith(f"Rendering with --caustics {used}")
    assert "times as efficient" in line
    assert json.loads(told.out)["caustics"] == used
    assert run(["render", scene, *LONG, "--quiet", "-o", "out.exr"]) == 0
    rest = capsys.readouterr().err
    assert "Rendering" not in rest
    assert all(line.startswith("glrt: caution: ") for line in rest.splitlines()), "these remain"


def test_gains_beyond_belief_are_not_spelled_out() -> None:
    on = settings_for(Settings(), caustics="on", **CHOICES[1])
    assert command.told(caustics.Finding(on, 1.234)) == (
        "Rendering with --caustics on --particles 0.1 --aimed 0.95 --linked 0: about 1.2 times as "
        "efficient as without, by a short pilot."
    )
    assert ": over 100 times as efficient" in command.told(caustics.Finding(on, 1e9))


def test_a_picture_goes_on_with_its_choice_and_says_so() -> None:
    """One render of all samples has a larger pilot, or the only one."""
    scene = load("cornell")
    settings = settings_for(scene.render, samples=128)
    given = Namespace()
    for begun, said in ((64, True), (127, True), (128, False)):
        image = Image(np.ones((1, 1, 3), np.float32), np.ones((1, 1, 3), np.float32), begun)
        order = Order(scene, settings, Limits(128), begun=image)
        assert bool(command.kept(given, order)) == said, begun
    assert "as the picture began. One render of 128 samples" in command.kept(
        given, replace(order, begun=replace(image, samples=64))
    )
    assert not command.kept(Namespace(caustics="off"), order)
    matte = replace(order, scene=load("methods/diffuse"))
    assert not command.kept(given, replace(matte, begun=replace(image, samples=64)))
