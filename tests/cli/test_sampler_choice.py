"""`--sampler auto`: long blocks for long renders, where nothing else is asked for."""

from pathlib import Path

import pytest

from glrt import merge
from glrt.cli.commands import parse, run
from glrt.cli.request import order
from glrt.cli.sampler import (
    BY_ERROR,
    LEAST,
    by_length,
    may_lengthen,
    sampler_for,
    sampler_to_error,
)
from glrt.gpu.context import Context
from glrt.image.image import Image, read_recipe
from tests.shaders.test_sobol import lit
from tests.support.renders import rendered, same

SCENE = ("lit.toml", "--width", "8", "--height", "6", "--quiet")
LONG = (*SCENE, "--samples", str(LEAST))


def chosen(*words: str, file: str = "out.exr") -> tuple[str, str | None]:
    """The sampler of the picture that `glrt render` makes, and why it was chosen."""
    assert run(["render", *words, "-o", file]) == 0
    recipe = read_recipe(Path(file))
    assert recipe
    return recipe.settings.sampler, recipe.decisions.get("sampler")


@pytest.fixture(autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The folder of commands, with a scene whose kernels other tests compile, too."""
    monkeypatch.chdir(tmp_path)
    lit().save("lit.toml")


def test_long_renders_have_long_blocks_and_short_ones_have_16(context: Context) -> None:
    assert chosen(*LONG) == ("sobol64", by_length("sobol64"))
    image = rendered(lit(), context, LEAST, sampler="sobol64", width=8, height=6)
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
        (["--samples", "2047"], "sobol64"),
        (["--samples", "2048"], "sobol256"),
        (["--samples", "2048", "--part", "1/9"], "sobol64"),
        (["--samples", "8191"], "sobol256"),
        (["--samples", "8192"], "sobol1024"),
        (["--samples", "100000", "--error", "0.9"], "sobol"),
    ],
)
def test_it_is_chosen_only_where_it_is_left_open(words: list[str], sampler: str) -> None:
    arguments = parse(["render", *LONG, *words, "-o", "out.exr"])
    assert order(arguments).settings.sampler == sampler


def test_each_part_of_a_render_has_a_whole_block() -> None:
    found = [sampler_for(2048, parts) for parts in (1, 8, 9, 32, 33)]
    assert found == ["sobol256", "sobol256", "sobol64", "sobol64", "sobol"]


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
    assert chosen("long.exr", "--samples", "64", "--quiet") == ("sobol64", by_length("sobol64"))


def test_parts_choose_as_the_whole_does() -> None:
    parts = []
    for number in (1, 2):
        file = f"{number}.exr"
        assert chosen(*LONG, "--part", f"{number}/2", file=file)[0] == "sobol64"
        parts.append(Image.load(file))
    chosen(*LONG)
    assert merge(parts).samples == Image.load("out.exr").samples == LEAST


def test_a_film_chooses_as_a_render_does() -> None:
    arguments = parse(["film", *LONG, "--turntable", "2", "-o", "%02d.exr"])
    assert order(arguments).settings.sampler == "sobol64"


@pytest.fixture
def of_few(monkeypatch: pytest.MonkeyPatch) -> None:
    """Renders to an error may have longer blocks, however small they are."""
    monkeypatch.setattr("glrt.cli.sampler.MUCH", 0)
    monkeypatch.setattr("glrt.cli.sampler.MANY", 8)


@pytest.mark.usefixtures("of_few")
def test_a_render_to_an_error_has_blocks_by_its_forecast(context: Context) -> None:
    """The picture is that of a render of as many samples with these blocks."""
    first = rendered(lit(), context, 64, sampler="sobol", width=8, height=6).error
    assert first
    limit = f"{first / 4:.6f}"  # 1,024 samples by the forecast
    assert chosen(*SCENE, "--error", limit) == ("sobol64", BY_ERROR)
    found = Image.load("out.exr")
    image = rendered(lit(), context, found.samples, sampler="sobol64", width=8, height=6)
    assert same(found, image)
    assert found.error
    assert found.error <= first / 4
    assert chosen(*SCENE, "--error", limit, "--sampler", "sobol") == ("sobol", None)


@pytest.mark.parametrize(
    ("words", "may"),
    [
        ([], True),
        (["--sampler", "auto"], True),
        (["--sampler", "sobol"], False),
        (["--time", "60"], False),
        (["--denoise", "nlm"], False),
        (["--adaptive", "on"], False),
        (["--method", "phong"], False),
        (["--method", "auto"], False),
    ],
)
def test_blocks_lengthen_only_where_they_are_left_open(words: list[str], may: bool) -> None:
    arguments = parse(["render", *SCENE, "--error", "1%", *words, "-o", "out.exr"])
    assert may_lengthen(arguments, order(arguments).settings) == may


def test_few_samples_to_an_error_keep_their_blocks(
    monkeypatch: pytest.MonkeyPatch, context: Context
) -> None:
    image = rendered(lit(), context, 64, sampler="sobol", width=8, height=6)
    assert image.error
    assert sampler_to_error(image, image.error / 8, 1 << 20) == "sobol"  # 4,096 of 48 pixels
    monkeypatch.setattr("glrt.cli.sampler.MUCH", 48 * 4096)
    assert sampler_to_error(image, image.error / 8, 1 << 20) == "sobol256"
    assert sampler_to_error(image, image.error / 7.9, 1 << 20) == "sobol"
    monkeypatch.setattr("glrt.cli.sampler.MUCH", 0)
    assert sampler_to_error(image, image.error / 8, 2047) == "sobol"
    assert sampler_to_error(image, image.error / 5, 1 << 20) == "sobol"  # 1,600 are too few
