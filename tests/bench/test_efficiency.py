"""The table of switches: variances are those of the pictures, ratios are to the first variant."""

import numpy as np
import pytest

from bench.efficiency import SCENES, Runs, Way, main, measure, scene_of, table
from glrt.gpu.context import Context
from glrt.scene.scenefile.catalog import scene_names


def test_a_row_holds_what_its_runs_did(context: Context) -> None:
    """With the sampler that knows its noise best, against what its pictures claim."""
    ways = {name: Way({"sampler": name}) for name in ("independent", "sobol")}
    first, second = measure(context, "sky", 16, 12, ways)
    assert (first.scene, first.variant) == ("sky", "independent")
    assert first.fewer_samples == first.slower == first.efficiency == 1
    assert second.fewer_samples == pytest.approx(first.variance / second.variance)
    assert second.efficiency == pytest.approx(second.fewer_samples / second.slower)
    assert second.fewer_samples > 1.2
    assert 0 < second.uncertainty < 0.2
    lines = list(table([first, second]))
    assert len(lines) == 4
    assert len({line.count("|") for line in lines}) == 1


def test_a_bright_pixel_is_not_the_measure_of_its_own_error(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Pixels of mean 1 that are 2.8 in a tenth of the pictures: their variance is 0.36."""
    drawn = np.random.default_rng(2)

    def bright(runs: Runs, seed: int) -> None:
        runs.seconds.append(1.0)
        is_bright = drawn.random((64, 64, 3)) < 0.1
        runs.pictures.append(np.where(is_bright, 2.8, 0.8).astype(np.float32))

    monkeypatch.setattr(Runs, "add", bright)
    first, second = measure(context, "sky", 8, 6, {"a": Way({}), "b": Way({})}, samples=1)
    for row in (first, second):
        assert row.variance == pytest.approx(0.36, rel=0.12)


def test_the_room_is_cornell_without_its_caustic() -> None:
    assert {*SCENES} <= {*scene_names(), "room"}
    room, cornell = scene_of("room"), scene_of("cornell")
    assert room.objects == cornell.objects
    assert {material.type for material in room.materials.values()} == {"lambertian", "light"}


def test_a_room_of_ground_glass_and_one_without_light_in_its_gap() -> None:
    gap, ground, downwards = (scene_of(it) for it in ("methods/gap", "ground", "downwards"))
    assert ground.objects == gap.objects
    alphas = {name: getattr(kind, "alpha", None) for name, kind in ground.materials.items()}
    assert {name for name, alpha in alphas.items() if alpha} == {"glass", "mirror"}
    differ = [(a, b) for a, b in zip(gap.objects, downwards.objects, strict=True) if a != b]
    (both, one) = differ.pop()
    assert (both.material, getattr(one, "emission_side", "")) == ("lamp", "front")
    assert not differ


def test_figures_are_printed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--scenes", "sky", "--size", "8", "--rounds", "2"]) == 0
    printed = capsys.readouterr().out
    assert "processors" in printed
    assert printed.count("| sky |") == 5


def test_unknown_scene_is_reported_in_one_paragraph(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--scenes", "ski", "--rounds", "2"]) == 2
    assert "sky" in capsys.readouterr().err


def test_a_single_round_has_no_spread(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        main(["--rounds", "1"])
    assert end.value.code == 2
    assert "--rounds: 1 is less than 2" in capsys.readouterr().err
