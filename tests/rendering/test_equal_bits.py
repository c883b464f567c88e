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
from glrt.plan.facts import SceneFacts
from glrt.plan.features import Needs, needs_of
from glrt.rendering.renderer import Renderer
from glrt.scene import instancing
from glrt.scene.materials.kinds import TYPES
from glrt.scene.shapes.kinds import KINDS, SAMPLED
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
    monkeypatch.setattr(instancing, "LEAST_SAVED", 1)


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
    """A render of two observations and a sample; beyond the floor where pixels have own counts."""
    scene, settings = RENDERS[name]
    more = 64 if "adaptive" in settings else 0
    renderer = Renderer(scene, context=context, **{**SIZE, **settings, **ways})
    try:
        image = renderer.render(2 * renderer.settings.block + 1 + more).image()
        assert renderer.nonfinite() == 0
    finally:
        renderer.release()
    return image


@pytest.fixture(scope="module")
def known() -> dict[str, Image]:
    """Pictures by the kernel that users get, as they are asked for."""
    return {}


@pytest.fixture
def usual(software: Context, name: str, known: dict[str, Image]) -> Image:
    """The picture by the generic kernel that users get, through a compute shader."""
    if name not in known:
        known[name] = picture(name, software)
    assert known[name].radiance.any()
    return known[name]


def test_the_renders_use_every_feature() -> None:
    found: dict[str, set[Any]] = {field.name: set() for field in fields(Needs)}
    for scene, settings in RENDERS.values():
        needs = needs_of(SceneFacts(scene), settings_for(scene.render, **settings))
        for feature, values in found.items():
            value = getattr(needs, feature)
            values |= value if isinstance(value, frozenset) else {value} - {0}
    assert [feature for feature, values in found.items() if not values] == []
    assert found["shapes"] == set(KINDS)
    assert found["materials"] == set(TYPES)
    assert found["lamps"] == set(SAMPLED)


@pytest.mark.slow_cases("by constants", "by long blocks", "by own counts", "by shared numbers*")
@pytest.mark.slow_cases("caustics", "shared places", "hazy", "hazy by *", "drawn", "mapped")
@pytest.mark.parametrize("name", RENDERS)
def test_the_kernel_of_a_profile(software: Context, usual: Image, name: str) -> None:
    """Other tests render by these: features that a scene leaves out change no bit."""
    with profiles.shared():
        image = picture(name, software)
    assert same(image, usual)


WAYS = [  # a crowd has too many shapes to be baked; some lack a fragment shader
    *((name, "tier", "complete") for name in RENDERS if name != "crowd"),
    *(
        (name, "pipeline", "fragment")
        for name in RENDERS
        if name
        not in ("caustics", "shared places", "by long blocks", "by own counts", "by shared numbers")
    ),
]


@pytest.mark.slow_cases(
    *("by constants-tier-complete", "by constants-pipeline-fragment"),
    *("drawn-tier-complete", "drawn-pipeline-fragment"),
    *("hazy by *", "by long blocks-tier-complete", "by shared numbers-*"),
    *("by own counts-tier-complete", "caustics-tier-complete", "shared places-tier-complete"),
    *("hazy-pipeline-fragment", "mapped-pipeline-fragment"),
)
@pytest.mark.parametrize(("name", "key", "way"), WAYS)
def test_tiers_and_pipelines(
    software: Context, usual: Image, name: str, key: str, way: str
) -> None:
    image = picture(name, software, **{key: way})
    assert getattr(image.recipe, key) == way
    assert same(image, usual)


@pytest.mark.slow
@pytest.mark.parametrize("name", RENDERS)
def test_arrays_in_textures(
    software: Context, usual: Image, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(struct_arrays, "MOST_UNIFORM_BYTES", 0)
    assert same(picture(name, software), usual)


@pytest.mark.slow
@pytest.mark.parametrize("name", RENDERS)
def test_osmesa(osmesa: Context, usual: Image, name: str) -> None:
    assert osmesa.route == "osmesa"
    assert same(picture(name, osmesa), usual)
