"""`--sampler auto`: blocks of 64 samples for long renders, where nothing else is asked for."""

from pathlib import Path

import pytest

from glrt import merge
from glrt.cli.commands import parse, run
from glrt.cli.request import order
from glrt.cli.sampler import BY_LENGTH, LEAST
from glrt.gpu.context import Context
from glrt.image.image import Image, read_recipe
from glrt.image.sources import load
from tests.support.renders import rendered, same

SCENE = ("sky", "--width", "8", "--height", "6", "--bounces", "2", "--quiet")
LONG = (*SCENE, "--samples", str(LEAST))
SIZE = {"width": 8, "height": 6, "bounces": 2}


def chosen(*words: str, file: str = "out.exr") -> tuple[str, str | None]:
    """The sampler of the picture that `glrt render` makes, and why it was chosen."""
    assert run(["render", *words, "-o", file]) == 0
    recipe = read_recipe(Path(file))
    assert recipe
    return recipe.settings.sampler, recipe.decisions.get("sampler")


@pytest.fixture(autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def test_long_renders_have_blocks_of_64_and_short_ones_of_16(context: Context) -> None:
    assert chosen(*LONG) == ("sobol64", BY_LENGTH)
    image = rendered(load("sky"), context, LEAST, sampler="sobol64", **SIZE)
    assert same(Image.load("out.exr"), image)
    assert chosen(*SCENE, "--samples", str(LEAST - 1)) == ("sobol", None)


@pytest.mark.parametrize(
    ("words", "sampler"),
    [
        (["--sampler", "auto"], "sobol64"),
        (["--sampler", "sobol"], "sobol"),
        (["--sampler", "independent"], "independent"),
        (["--error", "0.9"], "sobol"),
        (["--time", "0.01"], "sobol"),
        (["--adaptive", "on"], "sobol"),
        (["--method", "phong"], "sobol"),
        (["--part", "3/8"], "sobol64"),
        (["--part", "3/9"], "sobol"),
    ],
)
def test_it_is_chosen_only_where_it_is_left_open(words: list[str], sampler: str) -> None:
    arguments = parse(["render", *LONG, *words, "-o", "out.exr"])
    assert order(arguments).settings.sampler == sampler


def test_a_picture_keeps_the_sampler_that_it_began_with(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert chosen(*SCENE, "--samples", "64", file="begun.exr")[0] == "sobol"
    more = ["--samples", str(LEAST)]
    assert chosen("--resume", "begun.exr", *more) == ("sobol", None)
    assert (
        "Rendering with --sampler sobol, as the picture began. One render of 512 samples takes "
        "sobol64 by default, and has other bits."
    ) in capsys.readouterr().err
    assert chosen("begun.exr", *more, "--quiet") == ("sobol", None)
    assert chosen(*LONG, file="long.exr")[0] == "sobol64"
    assert chosen("--resume", "long.exr", "--samples", str(2 * LEAST))[0] == "sobol64"
    assert "as the picture began" not in capsys.readouterr().err
    assert chosen("long.exr", "--samples", "64", "--quiet") == ("sobol64", BY_LENGTH)


def test_parts_choose_as_the_whole_does() -> None:
    parts = []
    for number in (1, 2):
        file = f"{number}.exr"
        assert chosen(*LONG, "--part", f"{number}/2", file=file)[0] == "sobol64"
        parts.append(Image.load(file))
    chosen(*LONG)
    assert merge(parts).samples == Image.load("out.exr").samples == LEAST


def test_frames_of_a_film_choose_alike() -> None:
    assert run(["film", *LONG, "--frames", "0-1", "--turntable", "2", "-o", "%02d.exr"]) == 0
    recipes = [read_recipe(Path(f"{number:02}.exr")) for number in (0, 1)]
    assert [recipe and recipe.settings.sampler for recipe in recipes] == ["sobol64"] * 2
