"""The tables of steps: each edit of the shaders has its place, and changes noise, not the mean."""

from collections.abc import Sequence

import numpy as np
import pytest

from bench.efficiency import Row, Way, renderer_of, scene_of
from bench.shader_edits import Edit, edited
from bench.steps import BY_FLUX, STARTS, TABLES, by_start, main, roulette
from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.packing.lamp_bounds import Bodies, bodies_of
from glrt.scene.shapes.kinds import Shape
from tests.support.renders import assert_agree, same

EDITS = {tuple(way.edits) for table in TABLES.values() for way in table.values()} - {()}
PLAIN = Way({})


def picture(context: Context, way: Way, samples: int = 32, seed: int = 0) -> Image:
    """Of three lamps: two quads and a ball."""
    renderer = renderer_of(scene_of("lamps"), way, 16, context)
    renderer.update(seed=seed)
    image = renderer.render(samples).image()
    assert renderer.nonfinite() == 0
    renderer.release()
    return image


@pytest.mark.slow
@pytest.mark.parametrize("edits", sorted(EDITS), ids=lambda edits: edits[-1].new)
def test_an_edit_gives_other_noise_and_the_same_picture(
    context: Context, edits: tuple[Edit, ...]
) -> None:
    changed = picture(context, Way({}, edits), 256)
    assert not same(changed, picture(context, PLAIN, 256))
    assert_agree(changed, picture(context, PLAIN, 256, seed=1), within=0.05)


@pytest.mark.slow
def test_edits_do_what_they_are_named_for(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """To the bits of the ways to have the same without them."""
    plain, never = picture(context, PLAIN), picture(context, Way({"roulette": False}))
    assert not same(plain, never)
    assert same(picture(context, Way({}, roulette("0.25"))), plain)
    assert same(picture(context, Way({}, roulette("0.25", 1000))), never)
    by_flux = picture(context, Way({}, BY_FLUX))

    def far(lamps: Sequence[Shape]) -> Bodies:
        found = bodies_of(lamps)
        apart = np.full_like(found.spread2, 2.0**40)
        return found._replace(center=np.zeros_like(found.center), spread2=apart)

    monkeypatch.setattr("glrt.packing.lights.bodies_of", far)  # none is nearer
    assert same(by_flux, picture(context, PLAIN))


def test_an_edit_without_its_place_is_an_error() -> None:
    with pytest.raises(KeyError, match="does not hold `gone`"):
        edited(Edit("integrators/path.glsl", "gone", "here"))


def test_starts_of_roulette_stand_next_to_each_other() -> None:
    def row(scene: str, start: str, sampler: str, efficiency: float) -> Row:
        return Row(scene, f"{start}, {sampler}", 1, 0, 1, 1, 1, efficiency)

    rows = [
        row(scene, start, sampler, (factor if sampler == "sobol" else 1) * (place + 1))
        for scene, factor in (("cornell", 4), ("lamps", 9))
        for place, start in enumerate(STARTS)
        for sampler in ("independent", "sobol")
    ]
    lines = list(by_start(rows))
    assert lines[0].startswith("| start | cornell | lamps | mean")
    assert len(lines) == 2 + len(STARTS)
    assert lines[3] == "| below 1/4, from bounce 3 | 8.00 (2.00) | 18.00 (2.00) | 12.00 |"


@pytest.mark.slow
def test_figures_are_printed(capsys: pytest.CaptureFixture[str]) -> None:
    """Of all tables, or of those that are named."""
    assert main(["--scenes", "sky", "--size", "8", "--rounds", "2"]) == 0
    printed = capsys.readouterr().out
    assert "processors" in printed
    assert printed.count("| sky |") == len(TABLES["steps"]) + len(TABLES["alone"]) + 1
    assert printed.count("| below ") == len(STARTS) - 1
    with pytest.raises(SystemExit) as end:
        main(["stairs"])
    assert end.value.code == 2
    assert "there is no table 'stairs'" in capsys.readouterr().err
