"""The scenes that come with glrt, and the gallery of them."""

from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from bench.contact_sheet import MOST_BYTES, save_sheet
from bench.gallery import main, render_gallery
from bench.weekend import scene_text
from glrt.core.errors import RenderError, UsageError
from glrt.core.resources import folder
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.rendering.renderer import Renderer
from glrt.scene.materials.light import Light
from glrt.scene.scene import Scene
from glrt.scene.scenefile.catalog import scene_names
from glrt.scene.shapes.sphere import Sphere
from glrt.setting_options import FrameOptions
from glrt.settings import settings_for
from glrt.testing import pictures
from glrt.testing.pictures import Pictures
from tests.support.alarms import ALPHA, book

SMALL = 24  # pixels of the longer side


def small_size(scene: Scene) -> FrameOptions:
    """Width and height of the scene's own aspect."""
    width, height = scene.render.width, scene.render.height
    scale = SMALL / max(width, height)
    return {"width": round(width * scale), "height": round(height * scale)}


def overlaps(a: Sphere, b: Sphere) -> bool:
    return float(np.linalg.norm(np.subtract(a.center, b.center))) < a.radius + b.radius


# --- scenes --------------------------------------------------------------------------------


def test_the_gallery_has_its_six_scenes() -> None:
    assert {"cornell", "lamps", "lens", "metals", "sky", "weekend"} <= set(scene_names())


@pytest.mark.parametrize("name", scene_names())
def test_a_scene_has_a_title_of_its_own(name: str) -> None:
    titles = [load(other).title for other in scene_names()]
    assert load(name).title
    assert titles.count(load(name).title) == 1


@pytest.mark.slow_cases("shading", "smoke")
@pytest.mark.parametrize("name", scene_names())
def test_a_scene_renders_to_something_finite_and_not_black(name: str, context: Context) -> None:
    scene = load(name)
    settings = settings_for(scene.render, samples=2, **small_size(scene))
    renderer = Renderer(scene, settings, context)
    radiance = renderer.render().image().radiance
    assert renderer.nonfinite() == 0
    assert np.isfinite(radiance).all()
    assert (radiance.max(axis=2) > 0).mean() > 0.5
    assert 0.05 < radiance.mean() < 2  # exposure 0 suits it
    renderer.release()


@pytest.fixture
def shared_context(monkeypatch: pytest.MonkeyPatch, context: Context) -> None:
    monkeypatch.setattr(pictures, "_context", lambda: context)


@pytest.mark.slow_cases("shading", "smoke")
@pytest.mark.parametrize("name", scene_names())
@pytest.mark.usefixtures("shared_context")
def test_a_scene_looks_as_it_did(name: str, picture: Pictures) -> None:
    """Write references of scenes that are to look otherwise: pytest --glrt-update on this file."""
    found = picture.check(name, **small_size(load(name)))
    assert found is None or found.sensitivity.light < 0.2, "the noise hides what changes"
    book(picture.alpha / ALPHA)


@pytest.mark.parametrize("name", scene_names())
def test_a_scene_uses_every_material_it_names(name: str) -> None:
    scene = load(name)
    assert set(scene.materials) == {thing.material for thing in scene.objects}


@pytest.mark.parametrize("name", scene_names())
def test_light_is_sampled_where_there_are_lamps(name: str) -> None:
    scene = load(name)
    has_lamps = any(isinstance(material, Light) for material in scene.materials.values())
    assert scene.render.method == ("mis" if has_lamps or scene.sun else "naive")


@pytest.mark.parametrize("name", scene_names())
def test_balls_neither_overlap_nor_sink_into_the_floor(name: str) -> None:
    balls = [thing for thing in load(name).objects if isinstance(thing, Sphere)]
    pairs = [(a, b) for i, a in enumerate(balls) for b in balls[:i] if overlaps(a, b)]
    floor = -1.0 if name == "cornell" else 0.0
    assert pairs == []
    assert [ball for ball in balls if ball.center[1] - ball.radius < floor - 1e-12] == []


def test_the_weekend_is_what_its_generator_makes() -> None:
    text = (folder("scenes") / "weekend.toml").read_text(encoding="utf-8")
    assert scene_text() == text
    assert scene_text(seed=1) != text
    assert len(text) < 100_000


def test_the_weekend_has_some_480_small_balls_and_three_large_ones() -> None:
    radii = [thing.radius for thing in load("weekend").objects if isinstance(thing, Sphere)]
    assert radii.count(1.0) == 3
    assert 460 <= radii.count(0.2) <= 484
    assert len(radii) == radii.count(1.0) + radii.count(0.2)


METHOD_SCENES = sorted((folder("scenes") / "methods").glob("*.toml"))


def test_fifteen_scenes_separate_the_methods_before_one_camera() -> None:
    """The exception is the room that is also closed behind the camera."""
    scenes = [load(f"methods/{file.stem}") for file in METHOD_SCENES]
    assert len(scenes) == 15
    assert len({scene.title for scene in scenes} - {None}) == 15
    closed = load("methods/gap")
    assert len({scene.camera for scene in scenes if scene != closed}) == 1
    assert not {file.stem for file in METHOD_SCENES} & set(scene_names()), "out of the gallery"
    for scene in scenes:
        assert set(scene.materials) == {thing.material for thing in scene.objects}


@pytest.mark.parametrize("file", METHOD_SCENES, ids=lambda file: file.stem)
def test_a_scene_that_separates_methods_suits_exposure_0(file: Path, context: Context) -> None:
    renderer = Renderer(load(file), context=context, samples=32, width=24, height=24)
    radiance = renderer.render().image().radiance
    assert renderer.nonfinite() == 0
    assert 0.2 < radiance.mean() < 2
    renderer.release()


# --- the gallery ---------------------------------------------------------------------------


class Links(HTMLParser):
    """The links and pictures of a page."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.found: list[str | None] = []
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found += [value for key, value in attrs if key in ("href", "src")]


def codes(file: Path) -> NDArray[np.uint8]:
    with Image.open(file) as picture:
        return np.asarray(picture)


def noise(file: Path, width: int = 600, height: int = 400) -> Path:
    """A picture that compresses badly."""
    draw = np.random.default_rng(1)
    Image.fromarray(draw.integers(0, 256, (height, width, 3), np.uint8)).save(file)
    return file


def test_the_gallery_holds_a_picture_and_a_page_that_shows_it(
    tmp_path: Path, context: Context, capsys: pytest.CaptureFixture[str]
) -> None:
    there = tmp_path / "new" / "gallery"
    [picture] = render_gallery(there, ["cornell"], context, samples=1, width=24, height=20)
    assert codes(there / "cornell.png").shape == (20, 24, 3)
    page = (there / "index.html").read_text(encoding="utf-8")
    assert set(Links(page).found) == {"cornell.png"}
    for text in (str(load("cornell").title), "1 samples in", "glrt render cornell -o cornell.png"):
        assert text in page
    assert (picture.samples, picture.size, picture.error) == (1, (24, 20), None)
    assert picture.seconds > 0
    assert capsys.readouterr().err.startswith("[1/1] cornell: 24 x 20, 1 samples in ")


@pytest.mark.parametrize("suffix", [".jpg", ".png"])
def test_a_contact_sheet_stays_below_its_size_even_of_noise(tmp_path: Path, suffix: str) -> None:
    pictures = [noise(tmp_path / f"{i}.png") for i in range(6)]
    save_sheet(pictures, tmp_path / f"sheet{suffix}")
    data = (tmp_path / f"sheet{suffix}").read_bytes()
    assert len(data) < MOST_BYTES
    assert data.startswith({".jpg": b"\xff\xd8\xff", ".png": b"\x89PNG"}[suffix])


def test_a_row_of_the_sheet_shows_pictures_of_all_aspects_whole(tmp_path: Path) -> None:
    colors = [(255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 0)]
    sizes = [(50, 50), (75, 50), (75, 50), (50, 50)]
    for i, (color, size) in enumerate(zip(colors, sizes, strict=True)):
        Image.new("RGB", size, color).save(tmp_path / f"{i}.png")
    save_sheet([tmp_path / f"{i}.png" for i in range(4)], tmp_path / "sheet.png")
    sheet = codes(tmp_path / "sheet.png")
    first, last = sheet[5], sheet[-5]
    counts = [int((first == color).all(axis=1).sum()) for color in colors]
    assert counts == [297, 445, 446, 0]  # (1200 - 2 * 6) in shares of 1, 1.5, 1.5
    assert (last == colors[3]).all(axis=1).sum() == 400  # a third of the width at most


def test_a_sheet_that_cannot_be_small_enough_is_refused(tmp_path: Path) -> None:
    with pytest.raises(RenderError, match=r"sheet\.jpg"):
        save_sheet([noise(tmp_path / "0.png")], tmp_path / "sheet.jpg", most_bytes=100)
    assert not (tmp_path / "sheet.jpg").exists()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--only", "cornel"], "did you mean 'cornell'?"),
        (["--only", "sky", "--samples", "0"], "samples must be"),
        (["--only", "sky", "--sheet", "sheet.gif"], "ends in .jpg or .png"),
        (["--only", "sky", "--sheet", "nowhere/sheet.jpg"], "there is no folder nowhere"),
        (["--only", "sky", "-o", "file"], "Cannot make the folder file"),
    ],
)
def test_a_bad_command_is_refused_in_a_paragraph(
    arguments: list[str],
    message: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("file").touch()
    assert main(arguments) == UsageError.exit_code
    told = capsys.readouterr().err
    assert message in told
    assert told.splitlines()[-1].startswith("glrt: ")
