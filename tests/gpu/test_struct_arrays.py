"""The kernel reads its shapes as constants, uniform blocks or textures: the same bits each way."""

from typing import Any

import numpy as np
import pytest

from glrt.gpu import constant_arrays, struct_arrays
from glrt.gpu.context import Context
from glrt.gpu.struct_arrays import FILE, uniform_content
from glrt.image.sources import load
from glrt.packing.kernel_structs import STRUCTS
from glrt.plan.facts import MOST_BAKED
from glrt.rendering import pipelines
from glrt.rendering.pipelines import Tier
from glrt.rendering.renderer import Renderer
from glrt.rendering.shader_functions import no_rows
from glrt.scene.scene import Scene
from glrt.scene.scenefile.catalog import scene_names
from glrt.settings import Cost, Sampler
from tests.support.builders import MATTE, scene_of, sphere
from tests.support.kernel_text import written_for, written_for_everything
from tests.support.renders import SAMPLERS

pytestmark = pytest.mark.usefixtures("exact_kernels")
SMALL: dict[str, Any] = {"width": 24, "height": 24, "bounces": 6}


def bits(scene: Scene, context: Context, tier: Tier, sampler: Sampler) -> bytes:
    """Mean and error after two observations and a sample."""
    renderer = Renderer(scene, context=context, tier=tier, sampler=sampler, **SMALL)
    image = renderer.render(2 * renderer.settings.block + 1).image()
    renderer.release()
    return image.radiance.tobytes() + image.stderr.tobytes()


@pytest.mark.slow
@pytest.mark.parametrize("sampler", SAMPLERS)
@pytest.mark.parametrize("name", scene_names())
def test_constants_uniform_blocks_and_textures_give_the_same_bits(
    name: str, sampler: Sampler, context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """This holds on the software drivers; a GPU may round otherwise."""
    if not context.is_software:
        pytest.skip("bits are promised on software drivers alone")
    scene = load(name)
    uniform = bits(scene, context, "generic", sampler)
    if len(scene.objects) <= MOST_BAKED:
        assert bits(scene, context, "placed", sampler) == uniform
    monkeypatch.setattr(pipelines, "MOST_BAKED", len(scene.objects))
    if len(scene.objects) <= 100:
        assert bits(scene, context, "complete", sampler) == uniform
    monkeypatch.setattr(struct_arrays, "MOST_UNIFORM_BYTES", 0)
    assert bits(scene, context, "generic", sampler) == uniform


def test_arrays_are_constants_uniform_blocks_or_textures() -> None:
    uniform, baked = written_for("cornell")[FILE], written_for("cornell", "baked")[FILE]
    assert "uniform QuadRows { Quad quad_rows[32]; };" in uniform
    assert "int quad_count() { return frame.quad_count; }" in uniform
    assert "const Plane plane_rows[5]" in baked
    assert "int plane_count() { return 5; }" in baked
    assert "uniform MaterialRows" in baked
    placed = written_for("cornell", "placed")[FILE]
    assert "const Plane plane_rows[5]" in placed
    assert "uniform ReadRows { vec4 read_rows[64]; };" in placed
    assert placed.count("    row.corner = read_rows[") == 1
    assert "usampler2D QuadRows" in written_for("cornell", uniform_bytes=0)[FILE]
    assert not any("buffer" in text for text in (uniform, baked))


def test_a_kernel_has_no_more_blocks_than_opengl_grants() -> None:
    """12 (`GL_MAX_FRAGMENT_UNIFORM_BLOCKS` of OpenGL 4.1); blocks that nothing reads count too."""
    text = written_for_everything()[FILE]
    assert 10 < text.count("layout(std140) uniform") <= 12
    text = pipelines.text_of(no_rows(), "generic", struct_arrays.MOST_UNIFORM_BYTES)
    assert text.count("layout(std140) uniform") == 1, "what is not there has no block"


def test_shapes_share_one_numbering() -> None:
    text = written_for("cornell")[FILE]
    assert "int first_sphere() { return 0; }" in text
    assert "int first_quad() { return sphere_count() + plane_count(); }" in text
    assert "bool up_to_plane(int number) { return number < first_quad(); }" in text
    assert "bool up_to_quad(int number) { return true; }" in text


def test_literals_keep_every_bit() -> None:
    rng = np.random.default_rng(1)
    words = rng.integers(0, 2**32, 2000, np.uint32).view(np.float32)
    values = np.concatenate(
        [words[np.isfinite(words)], np.array([0.0, -0.0, 1e-45, 3.4e38], np.float32)]
    )
    read_back = np.array([constant_arrays.literal(value) for value in values]).astype(np.float32)
    assert read_back.tobytes() == values.tobytes()
    assert all({".", "e"} & set(constant_arrays.literal(value)) for value in values)


def test_uniform_buffer_is_as_large_as_its_block_and_none_is_empty() -> None:
    rows = np.zeros(3, STRUCTS["Quad"])
    assert len(uniform_content(rows)) == struct_arrays.LEAST_ROWS * rows.itemsize
    assert len(uniform_content(np.zeros(0, STRUCTS["Light"]))) > 0


@pytest.mark.slow
def test_recipe_names_the_tier_and_many_shapes_are_not_baked(context: Context) -> None:
    balls = [sphere([i, 0, -9], 0.4, "m") for i in range(MOST_BAKED + 1)]
    for count, tier in ((MOST_BAKED, "baked"), (MOST_BAKED + 1, "generic")):
        scene = scene_of(balls[:count], {"m": MATTE}, background={"color": [1, 1, 1]})
        renderer = Renderer(scene, context=context, tier="baked", **SMALL)
        recipe = renderer.render(1).image().recipe
        assert recipe
        assert recipe.tier == tier
        renderer.release()


@pytest.mark.slow
def test_only_the_baked_tier_compiles_when_a_shape_moves(context: Context) -> None:
    scenes = [
        scene_of([sphere([x, 0, -5], 1.0, "m")], {"m": MATTE}, background={"color": [1, 1, 1]})
        for x in (0.0, 0.5)
    ]
    costs: dict[Tier, Cost] = {"generic": Cost.RESTART, "baked": Cost.RECOMPILE}
    for tier, cost in costs.items():
        renderer = Renderer(scenes[0], context=context, tier=tier, **SMALL)
        before = renderer.render(1).image().radiance
        assert renderer.update(scenes[1]) is cost
        assert not np.array_equal(renderer.render(1).image().radiance, before)
        renderer.release()
