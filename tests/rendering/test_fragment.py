"""The fragment pipeline: the same bits as by compute, also where there is no compute."""

import json
from pathlib import Path
from typing import Any

import moderngl
import numpy as np
import pytest

from glrt.doctor.report import examine
from glrt.gpu.context import Context
from glrt.gpu.evaluate import Probe
from glrt.gpu.struct_arrays import ROWS, Layout, scene_arrays, texture_of, write_rows
from glrt.image.image import Image
from glrt.image.sources import load
from glrt.packing.kernel_structs import STRUCTS
from glrt.rendering.passes import Resolved
from glrt.rendering.pipelines import Tier
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.scene.scenefile.catalog import scene_names
from tests.support.drivers import OLD_DRIVER
from tests.support.images import same_bits
from tests.support.mixed_scene import everything
from tests.support.processes import glrt
from tests.support.renders import METHODS, SAMPLERS
from tests.support.system_packages import needs_osmesa

SMALL: dict[str, Any] = {"width": 19, "height": 13, "bounces": 6}


def bits(scene: Scene, context: Context, pipeline: Resolved, **settings: Any) -> bytes:
    """Mean and error after two observations and a sample."""
    renderer = Renderer(scene, context=context, pipeline=pipeline, **{**SMALL, **settings})
    assert renderer.pipeline == pipeline
    image = renderer.render(2 * renderer.settings.block + 1).image()
    renderer.release()
    return image.radiance.tobytes() + image.stderr.tobytes()


@pytest.mark.slow
@pytest.mark.parametrize("sampler", SAMPLERS)
@pytest.mark.parametrize("name", scene_names())
def test_fragment_and_compute_give_the_same_bits(name: str, sampler: str, context: Context) -> None:
    """This holds on the software drivers; a GPU may round otherwise."""
    if not context.is_software:
        pytest.skip("bits are promised on software drivers alone")
    tiers: tuple[Tier, ...] = ("complete", "generic") if name == "cornell" else ("complete",)
    for tier in tiers:
        by_compute, by_fragment = (
            bits(load(name), context, pipeline, tier=tier, sampler=sampler)
            for pipeline in ("compute", "fragment")
        )
        assert by_fragment == by_compute


@pytest.mark.slow_cases("naive")
@pytest.mark.slow_cases("nee")
@pytest.mark.parametrize("method", METHODS)
def test_textures_hold_the_scene_where_blocks_are_too_small(method: str, context: Context) -> None:
    if not context.is_software:
        pytest.skip("bits are promised on software drivers alone")
    kind: Any = {"tier": "storage", "method": method}
    by_compute, by_fragment = (
        bits(everything(), context, pipeline, **kind) for pipeline in ("compute", "fragment")
    )
    assert by_fragment == by_compute


def test_a_crop_by_fragments_is_the_part_of_the_frame(context: Context) -> None:
    whole, part = (
        Renderer(everything(), context=context, pipeline="fragment", **SMALL, crop=crop)
        for crop in (None, (5, 3, 11, 9))
    )
    pixels = part.render(2).image().radiance
    assert (pixels == whole.render(2).image().radiance[3:12, 5:16]).all()
    whole.release()
    part.release()


def test_what_a_window_has_turned_on_does_not_touch_the_picture(context: Context) -> None:
    plain = bits(everything(), context, "fragment")
    with context.gl as gl:
        gl.enable(moderngl.BLEND | moderngl.CULL_FACE | moderngl.DEPTH_TEST)
        gl.blend_func = moderngl.ONE, moderngl.ONE
    disturbed = bits(everything(), context, "fragment")
    with context.gl as gl:
        gl.disable(moderngl.BLEND | moderngl.CULL_FACE | moderngl.DEPTH_TEST)
    assert disturbed == plain


def test_structs_survive_the_way_through_a_texture(ctx: moderngl.Context) -> None:
    for dtype in STRUCTS.values():
        if dtype.itemsize > 7 * 16:
            continue  # a frame is no array
        drawn = np.random.default_rng(1).integers(0, 256, (ROWS + 3) * dtype.itemsize, np.uint8)
        texture = texture_of(ctx, drawn.view(dtype))
        assert texture.width <= 16_384
        assert texture.height == 2
        assert texture.read().startswith(drawn.tobytes())
        texture.release()


def test_the_first_rows_of_a_texture_are_written_again(ctx: moderngl.Context) -> None:
    """Other rows stay, except those of the last line that is touched."""
    dtype = STRUCTS["Slot"]
    old, new = (np.full(5 * ROWS * dtype.itemsize, k, np.uint8).view(dtype) for k in (1, 2))
    for count in (1, ROWS, ROWS + 1, 5 * ROWS):
        texture = texture_of(ctx, old)
        write_rows(texture, new, count)
        found = np.frombuffer(texture.read(), np.uint8).reshape(texture.height, -1)
        lines = -(-count // ROWS)
        assert (found[:lines] == 2).all()
        assert (found[lines:5] == 1).all()
        texture.release()


def accessor(struct: str, rows: Any) -> str:
    """How a struct is read from a texture, without the frame."""
    text = scene_arrays({struct: rows}, (), Layout(), 0)
    return "\n".join(line for line in text.splitlines() if "frame" not in line.lower())


def test_accessor_reads_each_field_where_the_layout_has_it() -> None:
    text = accessor("Sphere", np.zeros(1, STRUCTS["Sphere"]))
    fields = "uintBitsToFloat(row0.xyz), uintBitsToFloat(row0.w), int(row1.x), int(row1.y)"
    assert f"Sphere({fields})" in text
    assert "vec2(1.5, 0.5)" in text, "the middle of a texel: beside it, chance decides"


@pytest.mark.slow_cases("*-Light", "1-*", "512-*")
@pytest.mark.parametrize("struct", ["Node", "Light", "Quad"])
@pytest.mark.parametrize("count", [1, ROWS, ROWS + 1, 5 * ROWS + 3, 1 + 2**16])
def test_each_row_of_a_texture_is_read_where_it_lies(
    ctx: moderngl.Context, struct: str, count: int
) -> None:
    """Rows hold numbers of their own in the first and the last field."""
    rows = np.zeros(count, STRUCTS[struct])
    names = list(rows.dtype.names or ())
    for code, name in enumerate((names[0], names[-1])):
        rows[name].reshape(count, -1)[:, 0] = 2 * np.arange(count) + code
    texture = texture_of(ctx, rows)
    value = {"Node": "vec2(row.sphere.x, row.box.x)", "Light": "vec2(row.shape, row.alias)"}
    probe = Probe(
        value.get(struct, "vec2(row.corner.x, row.dual_v.x)"),
        "vec2",
        f"precise {struct} row = {struct.lower()}_at(index);",
        accessor(struct, rows),
        ["structs/scene.glsl"],
    )
    index = np.random.default_rng(1).permutation(count)
    assert np.array_equal(
        probe.run(ctx, {"index": index}, {f"{struct}Rows": texture}),
        np.column_stack([2 * index, 2 * index + 1]),
    )
    texture.release()


@pytest.fixture
def old_driver(monkeypatch: pytest.MonkeyPatch, context: Context) -> None:
    if not context.is_software:
        pytest.skip("the old driver is Mesa's software with parts taken away")
    for name, value in OLD_DRIVER.items():
        monkeypatch.setenv(name, value)


@pytest.mark.parametrize("route", ["egl", "osmesa"])
def test_a_driver_without_compute_renders_the_same_picture(
    route: str, tmp_path: Path, old_driver: None, context: Context
) -> None:
    if route == "osmesa":
        needs_osmesa()
    arguments = ["--width", "32", "--height", "24", "--samples", "5", "--context", route]
    told = glrt("render", "cornell", "-o", f"{tmp_path}/a.exr", "--json", *arguments)
    assert told.returncode == 0, told.stderr
    assert json.loads(told.stdout)["pipeline"] == "fragment"
    old = Image.load(tmp_path / "a.exr")
    renderer = Renderer(load("cornell"), context=context, tier="complete", width=32, height=24)
    assert same_bits(old.radiance, renderer.render(5).image().radiance)
    renderer.release()


def test_compute_not_available_is_reported(tmp_path: Path, old_driver: None) -> None:
    told = glrt("render", "cornell", "-o", f"{tmp_path}/a.png", "--pipeline", "compute")
    assert told.returncode == 3
    assert "OpenGL 4.3" in told.stderr
    assert told.stderr.count("\n") == 1
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_the_doctor_finds_that_an_old_driver_works(old_driver: None) -> None:
    examined = examine("egl")
    assert examined.works
    assert "compute" not in examined.found
