"""Live probes that are updated in turn: who comes when, and what the maps hold in closed form."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from glrt.core.errors import SceneError
from glrt.gpu.context import Context
from glrt.packing.probes import Turn
from glrt.plan.plan import prepare
from glrt.plan.probe_grid import grid_of, updated_at_once
from glrt.rendering.renderer import Renderer
from glrt.scene.probes import Probes
from glrt.scene.scene import Scene, with_lights
from glrt.settings import Cost, settings_for
from tests.rendering.test_live_probes import DIM, dimmed, lit, tracer_of, warmed_up
from tests.support.images import same_bits
from tests.support.renders import rendered, rendering
from tests.truths.test_probes import WAY, inner, room

KEPT = 0.75
COUNTS = (8, 27, 100, 125, 512, 4096)


def with_share(scene: Scene, share: float) -> Scene:
    return scene.model_copy(update={"probes": Probes(per_update=share)})


def turns(probes: int, length: int, updates: int) -> list[Turn]:
    found = [Turn(probes, 0, length)]
    while len(found) < updates:
        found.append(Turn(probes, found[-1].next, length))
    return found


# --- the order -----------------------------------------------------------------------------------


@pytest.mark.parametrize("probes", COUNTS)
def test_each_round_updates_each_probe_once(probes: int) -> None:
    """Within a round, and wherever it begins; lengths that do not divide the number go on."""
    for length in {1, 2, max(probes // 4, 1), probes // 3 + 1, probes}:
        times: NDArray[np.int64] = np.zeros(probes, np.int64)
        for number, turn in enumerate(turns(probes, length, 3 * -(-probes // length)), start=1):
            np.add.at(times, turn.numbers, 1)
            assert times.sum() == number * length
            assert times.max() - times.min() <= 1


def test_a_part_of_the_probes_lies_all_over_the_grid() -> None:
    """Each octant of 8 x 8 x 8 probes has its share of each quarter, half more or less."""
    for turn in turns(512, 128, 4):
        z, y, x = np.unravel_index(turn.numbers, (8, 8, 8))
        octants = np.bincount(4 * (z // 4) + 2 * (y // 4) + x // 4, minlength=8)
        assert octants.min() >= 16 / 2
        assert octants.max() <= 16 * 3 / 2


@pytest.mark.parametrize(
    ("share", "probes", "length"),
    [(1.0, 125, 125), (0.2, 125, 25), (0.1, 125, 13), (0.07, 100, 7), (1e-6, 8, 1)],
)
def test_the_share_is_rounded_up(share: float, probes: int, length: int) -> None:
    assert updated_at_once(with_share(room("planes", 0.5), share), probes) == length


# --- the key -------------------------------------------------------------------------------------


def test_a_share_needs_no_box() -> None:
    scene = room("planes", 0.5)
    settings = settings_for(scene.render, method="ddgi")
    usual, shared = grid_of(scene, settings), grid_of(with_share(scene, 0.5), settings)
    assert usual.places().tolist() == shared.places().tolist()


@pytest.mark.parametrize(
    ("table", "text"),
    [
        ({"per_update": 0}, "per_update must be greater than 0"),
        ({"per_update": 1.5}, "per_update must be at most 1"),
        ({"min": [0, 0, 0]}, "min and max go together"),
        ({"max": [0, 0, 0]}, "min and max go together"),
    ],
)
def test_a_wrong_table_is_refused(table: dict[str, Any], text: str) -> None:
    with pytest.raises(SceneError, match=text):
        room("planes", 0.5, probes=table)


def test_the_first_share_below_1_compiles_and_others_restart() -> None:
    scene = room("planes", 0.5)
    for method, first in (("ddgi", Cost.RECOMPILE), ("mis", Cost.RESTART)):
        plan = prepare(scene, settings_for(scene.render, method=method))
        assert plan.cost_of(with_share(scene, 1.0), plan.settings, "none") is Cost.RESTART
        assert plan.cost_of(with_share(scene, 0.5), plan.settings, "none") is first
    half = prepare(with_share(scene, 0.5), settings_for(scene.render, method="gather"))
    assert half.cost_of(with_share(scene, 0.1), half.settings, "none") is Cost.RESTART


# --- what the maps hold --------------------------------------------------------------------------


def live(context: Context, albedo: float, share: float) -> Any:
    """A renderer of live probes that have just seen the light of their room dimmed."""
    scene = with_share(room("sphere", albedo), share)
    return rendering(scene, context, **WAY, bounces=3, roulette=False)


def begin(renderer: Renderer) -> None:
    renderer.render(1)
    renderer.update(dimmed(renderer.scene), hysteresis=KEPT)


@pytest.mark.slow
@pytest.mark.parametrize("share", [0.5, 0.25, 0.375])
def test_an_update_changes_the_maps_of_its_probes_alone(context: Context, share: float) -> None:
    with live(context, 0.01, share) as renderer:
        begin(renderer)
        tracer = tracer_of(renderer)
        with context.gl:
            for turn in turns(8, round(8 * share), 8):
                before = [inner(tracer, name).copy() for name in ("probe_light", "probe_distances")]
                assert tracer.follow(KEPT) == turn
                after = [inner(tracer, name) for name in ("probe_light", "probe_distances")]
                for old, new in zip(before, after, strict=True):
                    changed = np.flatnonzero((old != new).any(axis=(1, 2, 3)))
                    assert changed.tolist() == sorted(turn.numbers)


@pytest.mark.slow
@pytest.mark.parametrize("method", ["ddgi", "gather"])
def test_light_lags_as_many_times_longer_as_the_share_is_smaller(
    context: Context, method: str
) -> None:
    """By quarters, four updates bring what one brings to all; nearly all light is one bounce."""
    scene, albedo = with_share(room("sphere", 0.01), 0.25), 0.01
    ways = {**WAY, "method": method, "bounces": 4, "roulette": False}
    with rendering(scene, context, **ways) as renderer:
        begin(renderer)
        held = warmed_up(albedo)
        for number in range(1, 13):
            renderer.update(dimmed(scene), hysteresis=KEPT, seed=number)
            renderer.render(1)
            rounds, rest = divmod(number, 4)
            share = 1 - rest / 4 * (1 - KEPT)
            assert renderer.probes.lag == pytest.approx(KEPT**rounds * share)
            if rest == 0:
                held = KEPT * held + (1 - KEPT) * albedo * (DIM + held)
                with context.gl:
                    np.testing.assert_allclose(lit(renderer), held, rtol=2e-3)


@pytest.mark.slow
@pytest.mark.parametrize("share", [0.25, 0.375])
def test_a_scene_that_rests_gets_the_light_of_its_closed_form(
    context: Context, share: float
) -> None:
    """Albedo 1/2: a room that shines with DIM holds DIM (1/2) / (1 - 1/2) in the end."""
    with live(context, 0.5, share) as renderer:
        begin(renderer)
        with context.gl:
            for _ in range(round(70 / share)):
                tracer_of(renderer).follow(KEPT)
            np.testing.assert_allclose(lit(renderer), DIM, rtol=2e-3)


@pytest.mark.slow
@pytest.mark.parametrize("method", ["ddgi", "gather", "resampled"])
def test_a_picture_at_rest_has_the_bits_of_all_probes(context: Context, method: str) -> None:
    scene, ways = room("planes", 0.5), {**WAY, "method": method}
    usual = rendered(scene, context, 20, **ways)
    assert same_bits(rendered(with_share(scene, 0.3), context, 20, **ways).radiance, usual.radiance)


@pytest.mark.slow
def test_another_share_goes_on_in_the_order_without_lag(context: Context) -> None:
    """A share is no light: what probes hold stays as new as it was."""
    with live(context, 0.5, 0.25) as renderer:
        begin(renderer)
        renderer.render(1)
        lag = renderer.probes.lag
        place = tracer_of(renderer)._place_in_order
        assert (lag, place) == (1 - 2 / 8 * (1 - KEPT), 2)
        renderer.update(with_share(dimmed(room("sphere", 0.5)), 0.5), hysteresis=KEPT)
        assert renderer.probes.lag == lag
        assert tracer_of(renderer)._place_in_order == place
        assert with_lights(renderer.scene, {"glow": 1.0}).probes == Probes(per_update=0.5)
