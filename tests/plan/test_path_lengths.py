"""Light by the length of its paths: weighed as a fresh render of fewer bounces has it."""

import numpy as np
import pytest

from glrt.gpu.context import Context
from glrt.plan.plan import MOST_LAYERS
from glrt.settings import Cost
from tests.support.relit_room import layered, radiance, room, seen


@pytest.mark.parametrize("limit", [0, 1, 2, 3])
def test_fewer_bounces_equal_a_fresh_render_to_rounding(context: Context, limit: int) -> None:
    with (
        layered(room(2, 0.5), context, "lengths", roulette=False) as renderer,
        layered(room(2, 0.5), context, "none", bounces=limit, roulette=False) as fresh,
    ):
        renderer.render(16)
        assert renderer.update(bounces=limit) is Cost.RELIGHT
        assert np.allclose(radiance(renderer), radiance(fresh.render(16)), rtol=1e-5, atol=1e-6)
        assert renderer.update(bounces=4) is Cost.RELIGHT


def test_the_light_of_each_length_adds_up(context: Context) -> None:
    with layered(room(), context, "lengths", bounces=9) as renderer:
        assert renderer.plan.layers == MOST_LAYERS
        renderer.render(8)
        parts = [seen(renderer, renderer.plan.alone(length)) for length in range(MOST_LAYERS)]
        assert np.allclose(sum(parts), radiance(renderer), rtol=1e-4, atol=1e-6)
        assert all(part.any() for part in parts[1:]), "the camera does not see the lamp"
        assert renderer.plan.alone(8) == renderer.plan.alone(5), "the last layer holds the rest"


@pytest.mark.parametrize(("limit", "cost"), [(4, Cost.RELIGHT), (5, Cost.RESTART), (10, None)])
def test_a_limit_within_the_last_layer_restarts(
    context: Context, limit: int, cost: Cost | None
) -> None:
    with layered(room(), context, "lengths", bounces=10) as renderer:
        renderer.render(1)
        assert renderer.update(bounces=limit) is cost


@pytest.mark.slow
def test_more_bounces_than_traced_restart(context: Context) -> None:
    with layered(room(), context, "lengths", bounces=3) as renderer:
        renderer.render(1)
        assert renderer.update(bounces=4) in (Cost.RESTART, Cost.RECOMPILE)


def test_turning_layers_on_and_off_begins_again(context: Context) -> None:
    with layered(room(2), context, "none") as renderer:
        renderer.render(4)
        assert renderer.update(layering="lengths") is Cost.RECOMPILE
        renderer.render(4)
        assert renderer.update(layering="groups") is Cost.RECOMPILE
        assert renderer.update(layering="groups") is None
