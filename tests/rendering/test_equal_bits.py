"""The same picture to the bit by every kernel, tier, pipeline and route.

Software drivers promise it; a GPU may round otherwise.
"""

from collections.abc import Iterator
from dataclasses import fields
from typing import Any

import pytest

from glrt.gpu import struct_arrays
from glrt.gpu.context import Context, open_context
from glrt.image.image import Image
from glrt.methods.contents import SAMPLED
from glrt.methods.features import Needs, needs_of
from glrt.rendering.renderer import Renderer
from glrt.scene import own_trees
from glrt.scene.materials import TYPES
from glrt.scene.shapes import KINDS
from glrt.settings import settings_for
from tests.support import profiles
from tests.support.every_feature import RENDERS
from tests.support.renders import same
from tests.support.system_packages import needs_osmesa

SIZE: dict[str, Any] = {"width": 24, "height": 20, "bounces": 4}
pytestmark = pytest.mark.usefixtures("exact_kernels", "instances")


@pytest.fixture
def instances(monkeypatch: pytest.MonkeyPatch) -> None:
    """Meshes of few triangles have trees of their own where they are repeated."""
    monkeypatch.setattr(own_trees, "LEAST_SAVED", 1)


@pytest.fixture
def software(context: Context) -> Context:
    """A context that promises bits."""
    if not context.is_software:
        pytest.skip("bits are promised on software drivers alone")
    return context


@pytest.fixture(scope="module")
def osmesa() -> Iterator[Context]:
    """A context by OSMesa, in this process."""
    needs_osmesa()
    opened = open_context("osmesa")
    yield opened
    opened.gl.release()


def picture(name: str, context: Context, **ways: Any) -> Image:
    """A render of two observations and a sample."""
    scene, settings = RENDERS[name]
    renderer = Renderer(scene, context=context, **{**SIZE, **settings, **ways})
    try:
        image = renderer.render(2 * renderer.settings.block + 1).image()
        assert renderer.nonfinite() == 0
    finally:
        renderer.release()
    return image


@pytest.fixture(scope="module")
def expected() -> dict[str, Image]:
    """Pictures by the generic kernel of the session's context, as they are asked for."""
    return {}


def assert_same_bits(image: Image, name: str, context: Context, known: dict[str, Image]) -> None:
    """As by the generic kernel that users get, through a compute shader."""
    if name not in known:
        known[name] = picture(name, context)
    assert known[name].radiance.any()
    assert same(image, known[name])


def test_the_renders_use_every_feature() -> None:
    found: dict[str, set[Any]] = {field.name: set() for field in fields(Needs)}
    for scene, settings in RENDERS.values():
        needs = needs_of(scene, settings_for(scene.render, **settings))
        for feature, values in found.items():
            value = getattr(needs, feature)
            values |= value if isinstance(value, frozenset) else {value} - {0}
    assert [feature for feature, values in found.items() if not values] == []
    assert found["shapes"] == set(KINDS)
    assert found["materials"] == set(TYPES)
    assert found["lamps"] == set(SAMPLED)


@pytest.mark.parametrize("name", RENDERS)
def test_the_kernel_of_a_profile(software: Context, name: str, expected: dict[str, Image]) -> None:
    """Other tests render by these: features that a scene leaves out change no bit."""
    with profiles.shared():
        image = picture(name, software)
    assert_same_bits(image, name, software, expected)


@pytest.mark.parametrize("name", sorted(RENDERS.keys() - {"crowd"}))
def test_shapes_that_are_written_into_the_kernel(
    software: Context, name: str, expected: dict[str, Image]
) -> None:
    """Up to 32: a crowd is not baked."""
    image = picture(name, software, tier="baked")
    assert image.recipe
    assert image.recipe.tier == "baked"
    assert_same_bits(image, name, software, expected)


@pytest.mark.slow
@pytest.mark.parametrize("name", RENDERS)
def test_arrays_in_textures(
    software: Context, name: str, expected: dict[str, Image], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(struct_arrays, "MOST_UNIFORM_BYTES", 0)
    assert_same_bits(picture(name, software), name, software, expected)


@pytest.mark.parametrize("name", sorted(RENDERS.keys() - {"caustics", "shared places"}))
def test_a_fragment_shader(software: Context, name: str, expected: dict[str, Image]) -> None:
    """Particles and probes have none."""
    image = picture(name, software, pipeline="fragment")
    assert image.recipe
    assert image.recipe.pipeline == "fragment"
    assert_same_bits(image, name, software, expected)


@pytest.mark.slow
@pytest.mark.parametrize("name", RENDERS)
def test_osmesa(software: Context, osmesa: Context, name: str, expected: dict[str, Image]) -> None:
    assert osmesa.route == "osmesa"
    assert_same_bits(picture(name, osmesa), name, software, expected)
