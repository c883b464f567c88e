"""Terms of light: closed forms, the sum, and what recorded paths report."""

from typing import Any

import numpy as np
import pytest

from glrt.core.errors import UsageError
from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.image.sources import load
from glrt.rendering.paths.replay import pixel_paths
from glrt.rendering.paths.values import Contribution, Path
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene, with_lights
from glrt.settings import TERMS, Cost, Method, Term, settings_for
from tests.support.alarms import assert_near
from tests.support.builders import MATTE, glass, lamp, scene_of, sphere
from tests.support.first_hits import same_aovs
from tests.support.mixed_scene import everything
from tests.support.relit_room import room

BY_LENGTH: tuple[Term, ...] = ("emission", "direct", "indirect")
BY_KIND: tuple[Term, ...] = ("emission", "diffuse", "glossy", "transmission", "volume")


def rendered(scene: Scene, context: Context, samples: int, **settings: Any) -> Image:
    """A picture of 8 x 8 pixels with all terms, or as `settings` say."""
    options: dict[str, Any] = {"width": 8, "height": 8, "aov": TERMS, **settings}
    pipeline = options.pop("pipeline", "auto")
    renderer = Renderer(scene, None, context, pipeline=pipeline, **options)
    image = renderer.render(samples).image()
    renderer.release()
    return image


def assert_adds_up(image: Image) -> None:
    """Both sums are the picture, up to the rounding of their means."""
    for terms in (BY_LENGTH, BY_KIND):
        whole = sum(image.aovs[term].value.astype(np.float64) for term in terms)
        np.testing.assert_allclose(whole, image.radiance, rtol=3e-6, atol=1e-7)


# --- closed forms --------------------------------------------------------------------------------


@pytest.mark.parametrize("bounces", [0, 1, 6])
def test_a_closed_room_has_the_terms_of_a_geometric_series(context: Context, bounces: int) -> None:
    """Walls of radiance 1 and albedo 1/2 send 1/2^k after k scattering events; nothing is noise."""
    walls = {"type": "light", "emission": [1, 1, 1], "color": [0.5, 0.5, 0.5]}
    scene = scene_of([sphere([0, 0, 0], 5.0, "wall")], {"wall": walls})
    ways: dict[str, Any] = {"method": "naive", "roulette": False}
    image = rendered(scene, context, 32, bounces=bounces, **ways)
    scattered = [0.5**k for k in range(1, bounces + 1)]
    truths = {"emission": 1.0, "direct": sum(scattered[:1]), "indirect": sum(scattered[1:])}
    truths |= {"diffuse": sum(scattered)}
    for name, aov in image.aovs.items():
        assert (aov.value == truths.get(name, 0.0)).all(), name
        assert aov.stderr is not None
        assert aov.count is not None
        assert (aov.stderr == 0).all(), name
        assert (aov.count == 32).all()


KINDS = ("matte", "mirror", "glass", "medium")
APART = 100.0  # balls hide 1e-5 of the sky from each other


def balls(number: int) -> Scene:
    """A ball of each kind under an even sky, and a narrow view of one of them."""
    places = [[APART * i, 0, 0] for i in range(len(KINDS))]
    solid = [sphere(place, 1.0, name) for place, name in zip(places, KINDS[:3], strict=False)]
    fog = {**sphere(places[3], 1.0, "none"), "medium": "fog"}
    mirror = {"type": "metal", "color": [0.75, 0.75, 0.75]}
    return scene_of(
        [*solid, fog],
        {"matte": MATTE, "mirror": mirror, "glass": glass(1.5)},
        {"fov": 0.5, "position": [APART * number, 0, 20], "look_at": places[number]},
        media={"fog": {"scattering": [0.5, 0.5, 0.5]}},
        background={"color": [1, 1, 1]},
    )


@pytest.mark.slow
@pytest.mark.parametrize("number", range(len(KINDS)), ids=KINDS)
def test_light_belongs_to_what_scatters_it_first(context: Context, number: int) -> None:
    """Seen head-on, by scattering alone.

    A matte ball has its albedo, a mirror its reflectance. Glass of index 1.5 reflects 0.04 and lets
    the rest through. A medium of depth 1 along the view lets exp(-1) pass, and scatters the rest.
    """
    ways: dict[str, Any] = {"method": "naive", "roulette": False}
    image = rendered(balls(number), context, 512, bounces=60, **ways)
    assert_adds_up(image)
    gone = float(np.exp(-1.0))
    truths: dict[str, float] = (
        {"diffuse": 0.5},
        {"glossy": 0.75},
        {"glossy": 0.04, "transmission": 0.96},
        {"emission": gone, "volume": 1.0 - gone},
    )[number]
    for name in BY_KIND:
        found = image.aovs[name]
        assert found.stderr is not None
        mean = float(found.value.mean(dtype=np.float64))
        deviation = float(np.sqrt((found.stderr.astype(np.float64) ** 2).mean() / found.value.size))
        assert_near(mean, truths.get(name, 0.0), deviation + 1e-4)


# --- the sum, and other ways to the same terms -----------------------------------------------

METHODS: tuple[Method, ...] = (
    *("naive", "nee", "mis", "phong", "blinn", "whitted", "whitted_tree", "cook"),
    *("ddgi", "gather"),
)
WAYS = [("cornell", method) for method in METHODS]
WAYS += [("gloss", "mis"), ("gloss", "ddgi"), ("frosted", "mis"), ("fog", "mis"), ("fog", "naive")]


@pytest.mark.slow
@pytest.mark.parametrize(("name", "method"), WAYS)
def test_terms_add_up_to_the_picture_by_every_method(
    context: Context, name: str, method: Method
) -> None:
    image = rendered(load(name), context, 32, method=method, bounces=5, width=16, height=12)
    assert_adds_up(image)
    assert image.aovs["diffuse"].value.any()


@pytest.mark.slow
@pytest.mark.parametrize("name", ["everything", "gloss", "fog"])
def test_both_pipelines_give_the_same_bits(context: Context, name: str) -> None:
    if not context.is_software:
        pytest.skip("bits are promised on software drivers alone")
    scene = everything() if name == "everything" else load(name)
    asked: dict[str, Any] = {"bounces": 3, "aov": ("direct", "diffuse", "volume")}
    one = rendered(scene, context, 17, **asked)
    other = rendered(scene, context, 17, pipeline="fragment", **asked)
    assert same_aovs(one.aovs, other.aovs)


def lit_fog() -> Scene:
    """A ball of fog next to a lamp."""
    return scene_of(
        [{**sphere([0, 0, 0], 1.0, "none"), "medium": "fog"}, sphere([2.5, 0, 0], 1.0, "lamp")],
        {"lamp": lamp(5.0)},
        {"position": [0, 0, 6], "look_at": [0, 0, 0], "fov": 20},
        media={"fog": {"scattering": [1.0, 0.7, 0.4]}},
    )


@pytest.mark.slow
@pytest.mark.parametrize("name", ["gloss", "fog"])
def test_scattering_and_sampling_find_the_same_terms(context: Context, name: str) -> None:
    """Also at principled surfaces, where a direction belongs to the base and to the facets."""
    scene = load("gloss") if name == "gloss" else lit_fog()
    size: dict[str, Any] = {"width": 24, "height": 12, "bounces": 3}
    found = [rendered(scene, context, 2048, method=way, **size) for way in ("naive", "mis")]
    assert found[1].aovs["volume"].value.any() == (name == "fog")
    for term in TERMS:
        means, errors = zip(*(mean_of(image, term) for image in found), strict=True)
        assert_near(means[0], means[1], float(np.hypot(*errors)) + 1e-6)


def mean_of(image: Image, term: Term) -> tuple[float, float]:
    """Mean over the picture, and its standard error."""
    aov = image.aovs[term]
    assert aov.stderr is not None
    error = np.sqrt((aov.stderr.astype(np.float64) ** 2).sum()) / aov.value.size
    return float(aov.value.mean(dtype=np.float64)), float(error)


@pytest.mark.slow
def test_terms_see_the_probes_of_their_block(context: Context) -> None:
    """Each block of 16 samples has its own probes; `step` and `render` trace the same."""
    size: dict[str, Any] = {"width": 8, "height": 8, "bounces": 4, "method": "ddgi", "probes": 2}
    renderer = Renderer(load("cornell"), None, context, aov=BY_LENGTH, **size)
    renderer.step(64)
    stepped = renderer.image()
    renderer.release()
    assert_adds_up(rendered(load("cornell"), context, 64, **size))
    whole = sum(stepped.aovs[term].value.astype(np.float64) for term in BY_LENGTH)
    np.testing.assert_allclose(whole, stepped.radiance, rtol=3e-6, atol=1e-7)


# --- recorded paths ------------------------------------------------------------------------------


def terms_of(path: Path, light: Contribution) -> tuple[Term, Term]:
    """The terms by length and by kind; a surface that shines is a vertex of its own."""
    is_vertex = light.strategy != "light sampling" and light.source == "object"
    length = light.vertex - is_vertex
    if length == 0:
        return "emission", "emission"
    event = path.vertices[1].event
    kind: Term = "diffuse"
    if event.endswith("reflection"):
        kind = "glossy"
    elif event.endswith("transmission"):
        kind = "transmission"
    return "direct" if length == 1 else "indirect", kind


@pytest.mark.slow
@pytest.mark.parametrize("pixel", [(3, 5), (5, 6), (3, 0)])
def test_terms_are_those_of_recorded_paths(context: Context, pixel: tuple[int, int]) -> None:
    """In cornell, where each surface scatters in one way: matte walls, metal and glass."""
    scene, samples = load("cornell"), 64
    settings: dict[str, Any] = {"width": 8, "height": 8, "bounces": 6}
    image = rendered(scene, context, samples, **settings)
    wanted = settings_for(scene.render, **settings, samples=samples)
    sums = {term: np.zeros(3) for term in TERMS}
    for path in pixel_paths(scene, wanted, pixel, context=context).paths:
        for light in path.contributions:
            for term in {*terms_of(path, light)}:
                sums[term] += np.array(light.added) / samples
    assert sum(bool(found.any()) for found in sums.values()) >= 3
    for term, found in sums.items():
        column, row = pixel
        value = image.aovs[term].value[row, column]
        np.testing.assert_allclose(value, found, rtol=1e-5, atol=1e-6, err_msg=term)


# --- what changes, and what is refused -------------------------------------------------------


@pytest.mark.slow
def test_a_relit_lamp_is_traced_with_terms(context: Context) -> None:
    """Weights of layers do not reach terms; without terms they relight the picture."""
    size: dict[str, Any] = {"width": 8, "height": 8, "bounces": 3, "samples": 16}
    renderer = Renderer(room(2), None, context, layering="groups", aov=BY_LENGTH, **size)
    first = renderer.render().image()
    group = next(iter(renderer.scene.light_groups))
    cost = renderer.update(with_lights(renderer.scene, {group: 0.5}))
    dimmed = renderer.render().image()
    assert cost is Cost.RESTART
    whole = sum(dimmed.aovs[term].value.astype(np.float64) for term in BY_LENGTH)
    np.testing.assert_allclose(whole, dimmed.radiance, rtol=3e-6, atol=1e-7)
    assert dimmed.radiance.sum() < first.radiance.sum()
    renderer.update(aov=())
    assert renderer.update(with_lights(renderer.scene, {group: 0.25})) is Cost.RELIGHT
    renderer.release()


def test_resampling_refuses_terms_by_name(context: Context) -> None:
    with pytest.raises(UsageError, match="does not sort its light into terms"):
        Renderer(load("cornell"), None, context, method="resampled", reuse="none", aov=("direct",))


def test_settings_name_their_terms() -> None:
    asked = settings_for(load("cornell").render, aov=("normal", "indirect", "direct"))
    assert asked.terms == ("direct", "indirect")
