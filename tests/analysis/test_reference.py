"""References of charts: two halves without bias, closed forms, and a cache that is only a cache."""

import itertools
import math
import shutil
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from glrt.analysis import reference
from glrt.analysis.reference import OTHER_NUMBERS, Budget, Reference, closed_form, reference_for
from glrt.core.resources import folder
from glrt.error.estimate import relative_error
from glrt.gpu import glsl
from glrt.gpu.context import Context
from glrt.rendering.pipelines import PLAIN, Variant
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import MAX_SAMPLES, settings_for
from tests.support.alarms import assert_near
from tests.support.builders import MATTE, box_of_quads, glass, lamp, plane, scene_of, sphere
from tests.support.renders import assert_agree

BALL = sphere([0, 0, -3], 1, "matte")
LIT = scene_of([BALL, sphere([0, 2, -2], 0.5, "lamp")], {"matte": MATTE, "lamp": lamp(5.0)})


@pytest.fixture(autouse=True)
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A cache folder of the test's own."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return tmp_path / "glrt" / "references"


def furnace(level: float = 2.0, **more: Any) -> Scene:
    """A half-white ball that glows as much as it swallows, under an even sky."""
    materials = {"even": {**lamp(level / 2, 0.5)}, "mirror": {"type": "metal", "color": [1, 1, 1]}}
    objects = [sphere([0, 0, -3], 1, "even"), sphere([0, 2, -3], 0.5, "mirror")]
    return scene_of(objects, {**materials, **more}, background={"color": [level] * 3})


def small(scene: Scene, **changes: Any) -> Any:
    return settings_for(scene.render, **{"width": 8, "height": 8, "bounces": 4, **changes})


def of_noise(deviation: float, error: float, seed: int) -> tuple[Reference, np.ndarray[Any, Any]]:
    """Halves and a picture of 1, each with noise of its own."""
    draw = np.random.default_rng(seed)
    first, second = (1 + deviation * draw.normal(size=(64, 64, 3)) for _ in range(2))
    return Reference(first, second, 1, 1), 1 + error * draw.normal(size=(64, 64, 3))


def test_the_noise_of_the_reference_does_not_enter_the_error() -> None:
    """4 % of noise in the halves, 1 % to be measured: a single reference would say 3 to 4 %."""
    measured = []
    for seed in range(8):
        halves, picture = of_noise(0.04, 0.01, seed)
        measured.append(halves.squared_error(picture))
        assert np.square(picture - halves.radiance).mean() > 5 * 0.01**2
    assert np.mean(measured) == pytest.approx(0.01**2 / 1.01, rel=0.1)  # 5 deviations of 1.9 %


def test_a_reference_knows_its_own_error() -> None:
    halves, _ = of_noise(0.04, 0.01, 0)
    truth = np.square(halves.radiance - 1).mean() / 1.01
    assert halves.error == pytest.approx(np.sqrt(truth), rel=0.05)


def test_the_error_is_that_of_the_contract() -> None:
    halves, picture = of_noise(0.0, 0.2, 3)
    squares = relative_error(halves.radiance, np.abs(picture - 1))
    assert squares is not None
    assert halves.squared_error(picture) == pytest.approx(squares**2)


def test_black_pixels_of_a_black_picture_have_no_error() -> None:
    black = np.zeros((2, 2, 3))
    assert Reference(black, black, 1, 1).squared_error(black) == 0


@pytest.mark.parametrize(
    ("scene", "level"),
    [
        (furnace(), 2.0),
        (furnace(3.0), 3.0),
        (furnace(even=lamp(0.5, 0.5)), None),  # swallows more than it gives
        (furnace(even=glass()), None),
        (furnace(mirror={"type": "metal", "color": [1, 1, 1], "roughness": 0.5}), None),
        (LIT, None),
        (scene_of([], {}, background={"bottom": [1, 1, 1], "top": [1, 1, 2]}), None),
    ],
)
def test_an_even_furnace_is_known_in_closed_form(scene: Scene, level: float | None) -> None:
    assert closed_form(scene) == level


def test_a_closed_form_is_what_is_rendered(context: Context, cache: Path) -> None:
    scene = furnace()
    truth = reference_for(scene, small(scene), context, Budget(0.1, 1))
    assert (truth.samples, truth.error) == (0, 0)
    renderer = Renderer(scene, small(scene, bounces=500, method="naive"), context)
    assert truth.squared_error(renderer.render(256).image().radiance) < 0.02**2
    renderer.release()
    assert not cache.exists()


def test_a_closed_form_has_the_size_of_the_crop(context: Context) -> None:
    scene = furnace()
    cropped = settings_for(small(scene), crop=(1, 2, 3, 4))
    assert reference_for(scene, cropped, context, Budget(0.1, 1)).radiance.shape == (4, 3, 3)


def test_a_reference_that_is_given_up_is_not_kept(context: Context, cache: Path) -> None:
    calls = []

    def check(renderer: Renderer) -> bool:
        calls.append(renderer.samples)
        if len(calls) == 3:
            raise TimeoutError
        return True

    with pytest.raises(TimeoutError):
        reference_for(LIT, small(LIT), context, Budget(1e-9, 1e9), check=check)
    assert len(calls) == 3
    assert not cache.exists()


def test_a_reference_comes_from_the_cache_the_second_time(
    context: Context, cache: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = reference_for(LIT, small(LIT), context, Budget(0.5, 5))
    assert not np.array_equal(first.first, first.second), "independent halves"
    with monkeypatch.context() as patch:
        patch.setattr(reference, "Renderer", None)
        again = reference_for(LIT, small(LIT), context, Budget(0.5, 5))
    assert np.array_equal(again.first, first.first)
    assert np.array_equal(again.second, first.second)
    assert (again.samples, again.error) == (first.samples, first.error)
    reference_for(LIT, small(LIT, width=9), context, Budget(0.5, 5))
    reference_for(furnace(even=lamp(0.5, 0.5)), small(LIT), context, Budget(0.5, 5))
    assert len(list(cache.iterdir())) == 3


class Noisy:
    """A renderer that knows no end, and whose picture stays as it is."""

    settings = small(LIT)

    def __init__(self, level: float) -> None:
        self.level, self.taken = level, list[int]()

    def render(self, samples: int, _check: None) -> "Noisy":
        self.taken.append(samples)
        return self

    def image(self) -> Any:
        radiance = np.full((2, 2, 3), self.level)
        recipe = SimpleNamespace(scene=LIT, settings=self.settings)
        moments = {"radiance": radiance, "stderr": 0.1 * radiance, "samples": 64}
        return SimpleNamespace(**moments, recipe=recipe)


def test_a_reference_takes_no_more_samples_than_a_picture_holds() -> None:
    halves: Any = [Noisy(1.0), Noisy(2.0)]
    found = reference._rendered(halves, Budget(1e-9, 60.0), None, None)
    assert found.samples == MAX_SAMPLES
    assert [max(half.taken) for half in halves] == [MAX_SAMPLES] * 2


# --- random numbers ------------------------------------------------------------------------


def noise_of(variant: Variant, context: Context, seed: int, sampler: str) -> Any:
    """A picture of 16 samples less its mean over seeds, in deviations: (64, 64)."""
    settings = small(LIT, width=64, height=64, method="naive", sampler=sampler)
    renderer = Renderer(LIT, settings, context, variant=variant, seed=seed)
    image = renderer.render(16).image()
    truth = Renderer(LIT, settings_for(settings, method="nee", seed=99), context)
    noise = image.radiance[..., 0] - truth.render(1024).image().radiance[..., 0].astype(float)
    renderer.release()
    truth.release()
    return noise


def correlations(a: Any, b: Any, block: int) -> tuple[float, float]:
    """The correlation of means of blocks lit by chance, and its deviation if there is none."""
    side = len(a) // block
    means = [x.reshape(side, block, side, block).mean(axis=(1, 3)).ravel() for x in (a, b)]
    lit = means[0] != 0
    return float(np.corrcoef(means[0][lit], means[1][lit])[0, 1]), float(lit.sum() ** -0.5)


@pytest.mark.slow
@pytest.mark.parametrize("sampler", ["independent", "sobol"])
def test_references_share_no_noise_with_pictures_of_the_same_seed(
    context: Context, sampler: str
) -> None:
    """Pixels and means of blocks; two renderers of pictures share all of it."""
    for seed in (0, reference.SEEDS[0]):
        picture = noise_of(PLAIN, context, seed, sampler)
        other = noise_of(OTHER_NUMBERS, context, seed, sampler)
        for block in (1, 4):
            value, deviation = correlations(picture, other, block)
            assert_near(value, 0, deviation)
            assert correlations(picture, picture, block)[0] > 0.999


@pytest.mark.slow
def test_references_show_the_same_picture(context: Context) -> None:
    """Another family of numbers, the same mean."""
    pictures = []
    for variant in (PLAIN, OTHER_NUMBERS):
        settings = small(LIT, width=32, height=32)
        renderer = Renderer(LIT, settings, context, variant=variant)
        pictures.append(renderer.render(1024).image())
        renderer.release()
    assert not np.array_equal(pictures[0].radiance, pictures[1].radiance)
    assert_agree(pictures[0], pictures[1], within=0.05)


@pytest.mark.parametrize("damage", [b"", b"no archive", None])
def test_a_damaged_cache_is_made_again(context: Context, cache: Path, damage: bytes | None) -> None:
    first = reference_for(LIT, small(LIT), context, Budget(0.5, 5))
    (file,) = cache.iterdir()
    file.write_bytes(file.read_bytes()[:200] if damage is None else damage)
    again = reference_for(LIT, small(LIT), context, Budget(0.5, 5))
    assert np.array_equal(again.first, first.first)


def test_a_cache_that_cannot_be_written_is_done_without(
    context: Context, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").touch()
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    assert reference_for(LIT, small(LIT), context, Budget(0.5, 5)).samples


def test_samples_double_until_the_error_is_reached(context: Context) -> None:
    coarse = reference_for(LIT, small(LIT), context, Budget(0.5, 10))
    fine = reference_for(LIT, small(LIT), context, Budget(0.02, 10))
    assert fine.error <= 0.02 < coarse.error
    assert fine.samples > coarse.samples


def test_counted_samples_end_a_reference_whatever_the_clock_says(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each look at the test's clock takes an hour."""
    hours = itertools.count(step=3600.0)
    clock = SimpleNamespace(perf_counter=lambda: next(hours))
    monkeypatch.setattr(reference, "time", clock)
    ends = [
        reference_for(LIT, small(LIT), context, Budget(1e-9, math.inf, most)).samples
        for most in (255, 256, 1)
    ]
    assert ends == [128, 256, 64]


@pytest.mark.slow
def test_a_reference_follows_paths_far_beyond_the_settings(context: Context) -> None:
    """In a closed box of albedo 0.9 with glowing walls, 4 bounces leave 59 % of the light."""
    walls = {"wall": lamp(0.1, 0.9)}
    box = scene_of(box_of_quads("wall", 2.0), walls)
    truth = reference_for(box, small(box), context, Budget(0.01, 5))
    assert truth.bounces == reference.BOUNCES
    assert truth.radiance.mean() == pytest.approx(1.0, rel=0.01)


@pytest.mark.slow
@pytest.mark.usefixtures("loop_limit")
def test_the_loop_limit_bounds_the_paths(context: Context) -> None:
    walls = [plane([0, 0, -3 - i], [0, 0, 1], "lamp") for i in range(400)]
    scene = scene_of(walls, {"lamp": lamp()})
    truth = reference_for(scene, small(scene), context, Budget(1.0, 0.1))
    assert small(scene).bounces <= truth.bounces < reference.BOUNCES


@pytest.mark.slow
def test_every_shader_file_is_part_of_the_name_of_a_reference(
    context: Context, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two files of one name in two folders are two files."""
    shaders = tmp_path / "shaders_glsl"
    shutil.copytree(folder("shaders_glsl"), shaders)
    for module in (glsl, reference):
        monkeypatch.setattr(module, "folder", lambda name: tmp_path / name)
    names = {reference._key(LIT, small(LIT), context, Budget(0.1, 1.0, 64))}
    files = glsl.shader_files()
    for file in files:
        before = file.read_text()
        file.write_text(f"{before}// another\n")
        names.add(reference._key(LIT, small(LIT), context, Budget(0.1, 1.0, 64)))
        file.write_text(before)
    assert len(names) == 1 + len(files)
