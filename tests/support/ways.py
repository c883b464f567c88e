"""Laws of the ways to render: what must hold of each, alone or under another way."""

from collections.abc import Callable

import numpy as np

from glrt import Renderer, load, merge
from glrt.cli.commands import run
from glrt.image.image import Image
from glrt.plan.combinations import Way
from glrt.scene.animation.tracks import Animation, Track
from glrt.scene.scene import with_lights
from tests.support.renders import assert_agree, same

Options = list[str]
Render = Callable[[Options], Image]

X, Y, WIDTH, HEIGHT = CROP = (3, 2, 9, 7)
SIZE = ["--width", "16", "--height", "12", "--bounces", "4"]
ASKED = 1.0  # an error that 64 samples reach
OPTIONS: dict[Way, Options] = {
    Way.CROP: ["--crop", *map(str, CROP)],
    Way.AOV: ["--aov", "albedo,depth,object"],
    Way.TERMS: ["--aov", "emission,direct,indirect"],
    Way.FRAGMENT: ["--pipeline", "fragment"],
    Way.INDEPENDENT: ["--sampler", "independent"],
    Way.SHARED: ["--sampler", "shared"],
    Way.ADAPTIVE: ["--adaptive", "on"],
    Way.CLASSIC: ["--method", "phong"],
    Way.PROBES: ["--method", "ddgi", "--probes", "2"],
    Way.REUSE: ["--method", "resampled", "--reuse", "both", "--probes", "2"],
    Way.HYBRID: ["--method", "hybrid", "--effects", "shadows,reflections"],
    Way.MARCH: ["--method", "march", "--march-step", "0.1"],
    Way.PARTICLES: ["--caustics", "on"],
    Way.PILOT: ["--caustics", "auto"],
    Way.DENOISE: ["--denoise", "nlm"],
    Way.AUTO: ["--method", "auto", "--error", str(ASKED)],
    Way.TIME: ["--time", "0.1"],
    Way.ERROR: ["--error", str(ASKED)],
    Way.CLUSTER: ["--cluster", "local:1"],
}


def rendered(*words: str) -> Image:
    """The picture that `glrt render` makes."""
    assert run(["render", *words, "--quiet", "-o", "out.exr"]) == 0
    return Image.load("out.exr")


def plain(options: Options) -> Image:
    return rendered("cornell", *SIZE, *(["--samples", "64"] if is_open(options) else []), *options)


def is_open(options: Options) -> bool:
    """Whether nothing else limits the samples."""
    return not {"--time", "--error", "--samples"} & set(options)


# --- pictures that take several commands -----------------------------------------------------


def resumed(options: Options) -> Image:
    """A render resumed from half of the samples to all; limits are given at the end."""
    given = [] if not is_open(options) else options
    first = rendered("cornell", *SIZE, "--samples", "24", *given)
    first.save("half.exr")
    limits = options if not is_open(options) else ["--samples", "64"]
    return rendered("--resume", "half.exr", *limits)


def parts(options: Options) -> list[Image]:
    words = ["cornell", *SIZE, "--samples", "60", *options]
    images = [rendered(*words, "--part", f"{k}/3") for k in (1, 2, 3)]
    for number, image in enumerate(images, 1):
        image.save(f"part{number}.exr")
    return images


def merged(options: Options) -> Image:
    """A merged picture, rendered again."""
    merge(parts([])).save("merged.exr")
    return rendered("merged.exr", *options)


def relit(options: Options) -> Image:
    """A picture whose lamp was dimmed in the window, rendered again."""
    scene = load("lamps")
    size = {"width": 16, "height": 12, "bounces": 4, "samples": 64}
    renderer = Renderer(scene, layering="groups", **size)  # type: ignore[arg-type]
    renderer.render()
    group = next(iter(scene.light_groups))
    renderer.update(with_lights(scene, {group: 0.3}))
    renderer.image().save("relit.exr")
    renderer.release()
    return rendered("relit.exr", *options)


def save_moving() -> Options:
    """Write a scene in which the camera moves while the shutter is open; its name and size."""
    track = Track(target="camera.position", times=(0, 1), values=[[-0.2, 0, 2.9], [0.2, 0.1, 2.9]])
    scene, moves = load("cornell"), Animation(fps=1, tracks=(track,))
    camera = scene.camera.model_copy(update={"shutter": 1.0})
    scene.model_copy(update={"camera": camera, "animation": moves}).save("moving.toml")
    return ["moving.toml", *SIZE]


def blurred(options: Options) -> Image:
    samples = ["--samples", "64"] if is_open(options) else []
    image = rendered(*save_moving(), *samples, *options)
    assert image.recipe
    assert image.recipe.scene.is_blurred
    return image


BASES: dict[Way, Render] = {Way.MERGED: merged, Way.LAYERS: relit, Way.SHUTTER: blurred}


# --- laws ----------------------------------------------------------------------------------


def resume_law(options: Options) -> None:
    found = resumed(options)
    limits = options if is_open(options) else ["--samples", str(found.samples)]
    assert same(found, plain(limits))


def part_law(options: Options) -> None:
    """Merged, the parts are the picture, up to the rounding of float32."""
    whole = rendered("cornell", *SIZE, "--samples", "60", *options)
    found = merge(parts(options))
    np.testing.assert_allclose(found.radiance, whole.radiance, rtol=1e-5, atol=1e-6)
    np.testing.assert_allclose(found.stderr, whole.stderr, rtol=1e-3, atol=1e-6)
    for name, aov in whole.aovs.items():
        np.testing.assert_allclose(found.aovs[name].value, aov.value, rtol=1e-5, atol=1e-6)


def crop_law(render: Render) -> None:
    full, part = render([]), render(OPTIONS[Way.CROP])
    place = slice(Y, Y + HEIGHT), slice(X, X + WIDTH)
    assert np.array_equal(part.radiance, full.radiance[place])
    assert np.array_equal(part.stderr, full.stderr[place], equal_nan=True)


def aov_law(render: Render) -> None:
    """They change no bit of the picture, and are those of the plain render."""
    image = render(OPTIONS[Way.AOV])
    assert same(image, render([]))
    assert [*image.aovs] == ["albedo", "depth", "object"]
    assert image.aovs["albedo"].value.shape == image.radiance.shape
    assert image.aovs["object"].value.max() > 0


def terms_law(render: Render) -> None:
    """They change no bit of the picture, and add up to it where its last block is whole."""
    image = render(OPTIONS[Way.TERMS])
    assert same(image, render([]))
    values = [aov.value for aov in image.aovs.values()]
    if image.samples % 16 == 0:
        np.testing.assert_allclose(sum(values), image.radiance, rtol=1e-5, atol=1e-6)


def fragment_law(render: Render) -> None:
    image = render(OPTIONS[Way.FRAGMENT])
    assert image.recipe
    assert image.recipe.pipeline == "fragment"
    assert same(image, render([]))


def noise_law(way: Way, samples: int) -> Callable[[Render], None]:
    def law(render: Render) -> None:
        """Another noise, the same light."""
        many = ["--samples", str(samples)]
        one, other = render(many), render([*many, *OPTIONS[way]])
        assert not same(one, other)
        assert_agree(one, other, within=0.4)

    return law


def method_law(way: Way) -> Callable[[Render], None]:
    def law(render: Render) -> None:
        """It is the picture of the method: of light that it does not follow, without noise."""
        image = render(OPTIONS[way])
        assert image.recipe
        assert image.recipe.settings.method == OPTIONS[way][1]
        assert not same(image, render([]))
        assert np.isfinite(image.radiance).all()

    return law


def march_law(render: Render) -> None:
    """It has its own method, and without a grid the picture of mis, to the bit."""
    image = render(OPTIONS[Way.MARCH])
    assert image.recipe
    assert image.recipe.settings.method == "march"
    assert same(image, render([]))


def pilot_law(render: Render) -> None:
    """It is the picture of what was chosen."""
    image = render(OPTIONS[Way.PILOT])
    assert image.recipe
    found = image.recipe.settings
    names = ("caustics", "particles", "aimed", "linked")
    pairs = ((f"--{name}", str(getattr(found, name))) for name in names)
    assert same(image, render([word for pair in pairs for word in pair]))


def denoise_law(render: Render) -> None:
    """It changes no bit of the plain picture, and shows another in addition."""
    image = render(OPTIONS[Way.DENOISE])
    assert same(image, render([]))
    assert image.denoised().error >= 0
    assert np.isfinite(image.denoised().radiance).all()
    assert np.array_equal(image.shown, image.denoised().radiance)
    assert image.recipe
    if image.recipe.settings.method != OPTIONS[Way.CLASSIC][1]:  # which has next to no noise
        assert not np.array_equal(image.shown, image.radiance)


def auto_law(render: Render) -> None:
    image = render(OPTIONS[Way.AUTO])
    assert image.recipe
    method = image.recipe.settings.method
    bounces, samples = str(image.recipe.settings.bounces), str(image.samples)
    again = ["--method", method, "--bounces", bounces, "--samples", samples]
    assert same(image, render(again))


def limit_law(way: Way) -> Callable[[Render], None]:
    def law(render: Render) -> None:
        """The final picture is that of a render with so many samples."""
        image = render(OPTIONS[way])
        assert image.samples >= 1
        assert same(image, render(["--samples", str(image.samples)]))

    return law


def cluster_law(render: Render) -> None:
    """It is the picture in one piece, bit for bit, and continues as that one does."""
    found, whole = render(OPTIONS[Way.CLUSTER]), render([])
    assert same(found, whole)
    assert found.recipe == whole.recipe
    assert (found.film_state is None) == (whole.film_state is None)
    for one, other in zip(found.film_state or (), whole.film_state or (), strict=True):
        assert np.array_equal(one, other, equal_nan=True)


ALONE: dict[Way, Callable[[Options], None]] = {Way.RESUME: resume_law, Way.PART: part_law}
LAWS: dict[Way, Callable[[Render], None]] = {
    Way.CROP: crop_law,
    Way.AOV: aov_law,
    Way.TERMS: terms_law,
    Way.FRAGMENT: fragment_law,
    Way.INDEPENDENT: noise_law(Way.INDEPENDENT, 512),
    Way.SHARED: noise_law(Way.SHARED, 512),
    Way.ADAPTIVE: noise_law(Way.ADAPTIVE, 512),
    **{way: method_law(way) for way in (Way.CLASSIC, Way.PROBES, Way.REUSE, Way.HYBRID)},
    Way.MARCH: march_law,
    Way.PARTICLES: noise_law(Way.PARTICLES, 2048),
    Way.PILOT: pilot_law,
    Way.DENOISE: denoise_law,
    Way.AUTO: auto_law,
    Way.TIME: limit_law(Way.TIME),
    Way.ERROR: limit_law(Way.ERROR),
    Way.CLUSTER: cluster_law,
}
