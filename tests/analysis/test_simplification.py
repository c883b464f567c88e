"""Parts that a scene can do without, and the bound of the change when they go."""

import math
from typing import Any, cast

import numpy as np
import pytest

import glrt
from glrt.analysis.simplification import search
from glrt.analysis.simplification.difference import (
    PAIRS,
    Change,
    Differences,
    frame,
    relative,
    student,
)
from glrt.analysis.simplification.parts import Part, features_of, objects_of, without
from glrt.analysis.simplification.report import Saving, lines
from glrt.analysis.simplification.search import (
    MOST_TRIALS,
    Simplification,
    Step,
    _judged,
    _Search,
    check,
    simplified,
)
from glrt.core.errors import UsageError
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene, with_lights
from glrt.settings import Settings, settings_for
from tests.support.builders import MATTE, lamp, sphere
from tests.support.mixed_scene import MATERIALS, OBJECTS, everything

EYE = {"position": [0.0, 0.0, 5.0], "look_at": [0.0, 0.0, 0.0]}
SMALL = {"width": 16, "height": 16, "sampler": "independent", "bounces": 3}
SIX = ("cornell", "lamps", "lens", "metals", "sky", "weekend")


def balls(count: int, **tables: Any) -> Scene:
    """A row of matte balls of increasing size under a white sky."""
    things = [sphere([float(n), 0, 0], 0.001 * (n + 1), "white") for n in range(count)]
    sky = {"color": [1.0, 1.0, 1.0]}
    return Scene.build(EYE, things, materials={"white": MATTE}, background=sky, **tables)


class Additive:
    """Stands for rendered differences: the squared shares of removed objects add up."""

    def __init__(self, scene: Scene, shares: list[float]) -> None:
        self.scene = scene
        sizes = [thing.radius for thing in _balls(scene)]
        self.shares = dict(zip(sizes, shares, strict=True))
        self.asked = 0

    def change(self, scene: Scene, *_: Any) -> Change:
        self.asked += 1
        left = {thing.radius for thing in _balls(scene)}
        total = math.fsum(s**2 for radius, s in self.shares.items() if radius not in left)
        return Change((total,) * PAIRS)


def _balls(scene: Scene) -> list[Any]:
    return list(scene.objects)


def searched(shares: list[float], error: float) -> tuple[_Search, Additive]:
    found = Additive(balls(len(shares)), shares)
    it = _Search(cast(Differences, found), error, lambda _: None, bounces=0)
    it.take(objects_of(found.scene))
    return it, found


@pytest.mark.parametrize(
    ("risk", "freedom", "value"),
    [(0.05, 7, 1.8946), (0.025, 7, 2.3646), (0.25, 1, 1.0), (0.001, 3, 10.2145)],
)
def test_students_t_is_that_of_the_tables(risk: float, freedom: int, value: float) -> None:
    assert student(risk, freedom) == pytest.approx(value, rel=1e-3)


def test_the_bound_is_the_mean_and_t_standard_errors() -> None:
    change = Change((0.01, 0.02, 0.03, 0.04, 0.01, 0.02, 0.03, 0.04))
    stderr = np.std(change.squares, ddof=1) / math.sqrt(8)
    assert change.value == pytest.approx(math.sqrt(0.025))
    assert change.below(0.05) == pytest.approx(math.sqrt(0.025 + 1.8946 * stderr), rel=1e-3)
    assert Change((-0.01,) * 8).value == 0
    assert Change((0.0,)).below(0.05) == math.inf


def test_the_bound_holds_as_often_as_it_says() -> None:
    numbers = np.random.default_rng(7).normal(1.0, 0.5, (4000, PAIRS))
    missed = sum(Change(tuple(row)).below(0.05) < 1 for row in numbers)
    assert abs(missed - 200) < 4.5 * math.sqrt(4000 * 0.05 * 0.95)


def test_a_change_where_all_was_black_has_no_bound() -> None:
    black = np.zeros((1, 1, 3))
    assert relative(black, black) == 0
    assert relative(black + 1, black) == math.inf


def test_the_same_scene_changes_nothing_and_more_light_by_its_share(context: Context) -> None:
    scene = everything(OBJECTS, materials=MATERIALS)
    settings = settings_for(scene.render, **SMALL)
    brighter = with_lights(scene, {name: 1.1 * it for name, it in scene.light_groups.items()})
    found = Differences(scene, settings, context)
    try:
        assert found.change(scene, 3, 4).squares == (0.0,) * PAIRS
        more = found.change(brighter, 3, 16)
        assert 0.08 < more.value < 0.1001
        assert more.below(0.05) < 0.11
        assert len(found.change(brighter, 3, 4, lambda square: square > 1e-4).squares) == 1
    finally:
        found.release()


def test_two_objects_that_may_go_alone_but_not_together() -> None:
    for shares in ([0.014, 0.5], [0.5, 0.014]):
        assert len(searched(shares, 0.02)[0].gone) == 1
    both, found = searched([0.014, 0.014], 0.02)
    assert [part.owner for part in both.gone] == [0]
    apart = _Search(cast(Differences, found), 0.02, lambda _: None, bounces=0)
    for part in objects_of(found.scene):  # as a lamp and an object, of two lists
        apart.take([part])
    assert [part.owner for part in apart.gone] == [0]


def test_objects_behind_one_that_must_stay_can_go() -> None:
    it, _ = searched([0.001, 0.001, 0.5, 0.001, 0.001, 0.5], 0.02)
    assert [part.owner for part in it.gone] == [0, 1, 3, 4]


def test_five_hundred_objects_take_a_few_dozen_pictures() -> None:
    shares = [0.0002 * 1.01**n for n in range(500)]
    it, found = searched(shares, 0.02)
    assert found.asked == it.trials <= MOST_TRIALS < 50
    left = it.error**2 - math.fsum(shares[cast(int, part.owner)] ** 2 for part in it.gone)
    assert 0 < left < 0.3 * it.error**2
    assert len(it.gone) > 100


def test_bounces_leave_half_of_the_square_to_the_rest() -> None:
    class Shorter:
        scene = balls(1)

        def change(self, _: Scene, bounces: int, *__: Any) -> Change:
            return Change(((0.02 / (bounces + 1)) ** 2,) * PAIRS)

    it = _Search(cast(Differences, Shorter()), 0.01, lambda _: None, bounces=10)
    it.shorten()
    assert it.bounces == 3  # 0.5 % is below 0.9 % / sqrt(2), and 0.67 % is not
    assert [step.bounces for step in it.steps] == [3]


def test_a_judgement_that_fails_drops_what_came_last(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = balls(3)
    seeds: list[int] = []

    class Strict(Additive):
        scale = None

        def __init__(self, scene: Scene, *given: Any) -> None:
            super().__init__(scene, [0.001, 0.5, 0.5])
            seeds.append(given[2])

        def release(self) -> None:
            pass

    monkeypatch.setattr(search, "Differences", Strict)
    parts = objects_of(scene)
    it = _Search(cast(Differences, Additive(scene, [0] * 3)), 0.02, lambda _: None, 5)
    it.steps = [Step((parts[0],), None, 0.0), Step((parts[1],), None, 0.0)]
    found = _judged(it, Settings(), cast(Context, None))
    assert [part.owner for step in found.steps for part in step.parts] == [0]
    assert found.change == pytest.approx(0.001)
    assert found.bound < 0.02
    assert found.scene.objects == scene.objects[1:]
    assert len(set(seeds)) == 2
    it.steps = [Step((parts[1],), None, 0.0)]
    nothing = _judged(it, Settings(), cast(Context, None))
    assert (nothing.steps, nothing.change, nothing.scene.objects) == ((), 0.0, scene.objects)


def test_a_scene_loses_what_only_its_parts_used() -> None:
    materials = {"white": MATTE, "lamp": lamp(), "spare": MATTE}
    things = [sphere([0, 0, 0], 1, "white"), {**sphere([2, 0, 0], 1, "lamp"), "name": "bulb"}]
    scene = Scene.build(EYE, things, materials=materials, lights={"lamp": 2.0})
    bulb = objects_of(scene)[1]
    assert bulb.name == "lamp bulb"
    left = without(scene, [bulb])
    assert left is not None
    assert [*left.materials] == ["white"]
    assert left.lights == {}
    assert without(scene, objects_of(scene)) is None


def test_a_texture_gives_way_to_its_mean() -> None:
    board = {"checker": [[0.8, 0.4, 0.0], [0.2, 0.0, 0.0]], "factor": 0.5}
    paint = {"type": "principled", "color": board, "clearcoat": 0.5}
    scene = Scene.build(EYE, [sphere([0, 0, 0], 1, "paint")], materials={"paint": paint},
                        background={"color": [1, 1, 1]})  # fmt: skip
    parts = features_of(scene)
    names = ["the background", "texture color of paint", "clearcoat of paint"]
    assert [part.name for part in parts][:3] == names
    left = without(scene, parts[1:3])
    assert left is not None
    found = cast(glrt.Principled, left.materials["paint"])
    assert found.color == pytest.approx((0.25, 0.1, 0.0), rel=1e-3)
    assert (found.textures, found.clearcoat) == ({}, 0.0)


def test_what_cannot_be_judged_is_refused() -> None:
    with pytest.raises(UsageError, match="below 100 %"):
        check(balls(1), 1.0)
    with pytest.raises(UsageError, match="animated"):
        check(load("cradle"), 0.1)


def test_a_large_frame_is_measured_smaller_and_in_shape() -> None:
    small = frame(Settings(width=2000, height=1000, aov=("normal",)), 1 << 16)
    assert small.size == (362, 181)
    assert (small.sampler, small.aov) == ("independent", ())
    assert frame(Settings(width=40, height=30), 1 << 16).size == (40, 30)


def test_the_report_names_parts_and_what_they_save() -> None:
    parts = tuple(Part(f"object {n}", "objects", n) for n in range(8))
    steps = (Step((), 4, 0.005), Step(parts, None, 0.01))
    found = Simplification(0.02, balls(1), 4, steps, 0.01, 0.015, (64, 64), 16, 20, True)
    text = "\n".join(lines(found, Saving(0.5, ("glass",))))
    assert "0.5 %          bounces beyond 4\n" in text
    assert "object 5 and 2 more" in text
    assert "less than 1.5 % with 95 % confidence" in text
    assert "0.5 times the counted work. The kernel loses: glass." in text
    assert "object 7" in "\n".join(lines(found, Saving(0.5, ()), named=8))
    nothing = Simplification(0.02, balls(1), 4, (), 0, 0, (64, 64), 0, 20, True)
    assert next(lines(nothing, Saving(1, ()))).startswith("Nothing was found that can go")


@pytest.mark.slow
@pytest.mark.parametrize("name", SIX)
def test_independent_pictures_of_both_scenes_differ_by_less(name: str, context: Context) -> None:
    error, scene = 0.05, load(name)
    settings = settings_for(scene.render, width=96, height=96)
    found = simplified(scene, settings, error, context)
    assert found.bound < error
    pictures = []
    for number, (one, bounces) in enumerate(
        [(scene, settings.bounces), (found.scene, found.bounces)] * 2
    ):
        own = settings_for(settings, bounces=bounces, seed=900 + number)
        renderer = Renderer(one, own, context, sampler="independent")
        pictures.append(renderer.render(256).image())
        renderer.release()
    result = glrt.compare(pictures[1], pictures[0])
    assert all(max(it.low, -it.high) < error for it in result.differences)
    first, second, third, fourth = (it.radiance.astype(float) for it in pictures)
    whole = (first + third) / 2
    scale = whole**2 + 0.01 * whole.mean() ** 2
    squares = ((second - first) * (fourth - third) / scale).mean(axis=2)
    stderr = squares.std() / math.sqrt(squares.size)
    assert squares.mean() < error**2 + 4.5 * stderr
