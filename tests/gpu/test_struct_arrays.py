"""The kernel reads its shapes three ways, and renders the same bits with each."""

from typing import Any

import moderngl
import numpy as np
import pytest

from glrt.gpu import struct_arrays
from glrt.gpu.context import Context
from glrt.gpu.glsl import read
from glrt.gpu.struct_arrays import MOST_BAKED, blocks_text, padded
from glrt.image.sources import load
from glrt.rendering import pipelines
from glrt.rendering.pack import STRUCTS, pack_scene
from glrt.rendering.renderer import Renderer
from glrt.scene.catalog import scene_names
from glrt.scene.scene import Scene
from glrt.settings import Cost, Sampler
from tests.support.builders import MATTE, scene_of, sphere
from tests.support.renders import SAMPLERS

SMALL: dict[str, Any] = {"width": 24, "height": 24, "bounces": 6}


def bits(scene: Scene, context: Context, tier: struct_arrays.Tier, sampler: Sampler) -> bytes:
    """Mean and error after two observations and a sample."""
    renderer = Renderer(scene, context=context, tier=tier, sampler=sampler, **SMALL)
    image = renderer.render(2 * renderer.settings.block + 1).image()
    renderer.release()
    return image.radiance.tobytes() + image.stderr.tobytes()


@pytest.mark.parametrize("sampler", SAMPLERS)
@pytest.mark.parametrize("name", scene_names())
def test_constants_uniform_and_storage_blocks_give_the_same_bits(
    name: str, sampler: str, context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On the software drivers; a GPU may round otherwise."""
    if not context.is_software:
        pytest.skip("bits are promised on software drivers alone")
    scene = load(name)
    uniform = bits(scene, context, "generic", sampler)
    monkeypatch.setattr(struct_arrays, "MOST_BAKED", len(scene.objects))
    if len(scene.objects) <= 100:
        assert bits(scene, context, "baked", sampler) == uniform
    assert bits(scene, context, "storage", sampler) == uniform


@pytest.mark.parametrize("name", ["cornell", "weekend"])
def test_textures_give_the_same_bits(
    name: str, context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where no uniform block is large enough; as in the fragment pipeline, see test_fragment.py."""
    if not context.is_software:
        pytest.skip("bits are promised on software drivers alone")
    scene = load(name)
    uniform = bits(scene, context, "generic", "independent")
    monkeypatch.setattr(pipelines, "MOST_UNIFORM_BYTES", 0)
    assert bits(scene, context, "generic", "independent") == uniform


def test_text_has_storage_uniform_blocks_textures_or_constants() -> None:
    arrays = pack_scene(load("cornell"))
    assert "buffer" not in blocks_text(arrays)
    baked = blocks_text(arrays, "baked")
    assert "const Plane planes[5]" in baked
    assert "int plane_count() { return 5; }" in baked
    assert "uniform Materials" in baked
    assert blocks_text(arrays, "storage") == read("blocks.glsl")
    assert "usampler2D Quads" in blocks_text(arrays, uniform_bytes=0)


@pytest.mark.parametrize("tier", ["storage", "generic"])
def test_storage_blocks_lie_in_the_places_that_every_opengl_grants(
    context: Context, tier: struct_arrays.Tier
) -> None:
    if not context.has_compute:
        pytest.skip("there are storage blocks from OpenGL 4.3 on")
    renderer = Renderer(load("weekend"), context=context, tier=tier, **SMALL)
    program = renderer._tracer.turns.kernel._program
    members = [program[name] for name in program]
    with context.gl:
        places = [block.binding for block in members if isinstance(block, moderngl.StorageBlock)]
    renderer.release()
    assert sorted(places) == list(range(len(places)))
    assert len(places) <= 8


def test_literals_keep_every_bit() -> None:
    rng = np.random.default_rng(1)
    words = rng.integers(0, 2**32, 2000, np.uint32).view(np.float32)
    values = np.concatenate(
        [words[np.isfinite(words)], np.array([0.0, -0.0, 1e-45, 3.4e38], np.float32)]
    )
    read_back = np.array([struct_arrays._literal(value) for value in values]).astype(np.float32)
    assert read_back.tobytes() == values.tobytes()
    assert all({".", "e"} & set(struct_arrays._literal(value)) for value in values)


def test_uniform_buffer_is_as_large_as_its_block_and_none_is_empty() -> None:
    rows = np.zeros(3, STRUCTS["Quad"])
    assert len(padded(rows, "generic")) == struct_arrays.LEAST_ROWS * rows.itemsize
    assert padded(rows, "storage") == rows.tobytes()
    many = np.zeros(1000, STRUCTS["Quad"])
    assert padded(many, "generic") == many.tobytes(), "too large for a uniform block"
    assert len(padded(np.zeros(0, STRUCTS["Light"]), "storage")) > 0


def test_recipe_names_the_tier_and_many_shapes_are_not_baked(context: Context) -> None:
    balls = [sphere([i, 0, -9], 0.4, "m") for i in range(MOST_BAKED + 1)]
    for count, tier in ((MOST_BAKED, "baked"), (MOST_BAKED + 1, "generic")):
        scene = scene_of(balls[:count], {"m": MATTE}, background={"color": [1, 1, 1]})
        renderer = Renderer(scene, context=context, tier="baked", **SMALL)
        recipe = renderer.render(1).image().recipe
        assert recipe
        assert recipe.tier == tier
        renderer.release()


def test_only_the_baked_tier_compiles_when_a_shape_moves(context: Context) -> None:
    scenes = [
        scene_of([sphere([x, 0, -5], 1.0, "m")], {"m": MATTE}, background={"color": [1, 1, 1]})
        for x in (0.0, 0.5)
    ]
    costs: dict[struct_arrays.Tier, Cost] = {"generic": Cost.RESTART, "baked": Cost.RECOMPILE}
    for tier, cost in costs.items():
        renderer = Renderer(scenes[0], context=context, tier=tier, **SMALL)
        before = renderer.render(1).image().radiance
        assert renderer.update(scenes[1]) is cost
        assert not np.array_equal(renderer.render(1).image().radiance, before)
        renderer.release()
