"""Pictures with faults: an EXR and a PNG of glrt's own with wrong bytes somewhere."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
from hypothesis import strategies as st

from glrt.core.errors import GlrtError
from glrt.image.image import Image
from glrt.image.recipe import Recipe
from glrt.image.sources import load, load_recipe
from glrt.settings import settings_for
from tests.fuzz.checks import check_refusal

CORNELL = load("cornell")
NAME = Path("chance.png")


def whole_recipe() -> Recipe:
    """The recipe in a picture of glrt's own."""
    settings = settings_for(CORNELL.render, width=4, height=4)
    return Recipe(scene=CORNELL, settings=settings, samples=2, version="0", renderer="none")


def whole_pictures(folder: Path) -> list[Path]:
    """A picture of each kind that carries a recipe, 4 x 4."""
    grey = np.full((4, 4, 3), 0.5, np.float32)
    image = Image(grey, grey / np.float32(8), 2, whole_recipe())
    paths = [folder / "whole.exr", folder / "whole.png"]
    for path in paths:
        image.save(path)
    return paths


@st.composite
def broken(draw: st.DrawFn, content: bytes) -> bytes:
    """The content with one to five pieces cut, changed or put in, most of them in its header."""
    data = content
    for _ in range(draw(st.integers(1, 5))):
        start = draw(st.one_of(st.integers(0, 400), st.integers(0, len(data))))
        cut = draw(st.sampled_from([0, 1, 1, 4, len(data)]))
        data = data[:start] + draw(st.binary(max_size=8)) + data[start + cut :]
    return data


def check_picture(content: bytes, whole: Path) -> bool:
    """Read as a recipe and as an image, or refused with one paragraph; whether all was read.

    A PNG file has no radiance to be read as an image: it is always refused as one.
    """
    path = whole.with_stem("chance")
    path.write_bytes(content)
    has_recipe, is_image = (_is_read(reader, path) for reader in (load_recipe, Image.load))
    return has_recipe and (is_image or path.suffix == ".png")


def check_recipe(text: bytes) -> bool:
    """Read as the text of a recipe, or refused with one paragraph; whether it was read."""
    return _is_read(lambda name: Recipe.from_json(text.decode(errors="replace"), str(name)), NAME)


def _is_read(reader: Callable[[Path], object], path: Path) -> bool:
    try:
        reader(path)
    except GlrtError as error:
        check_refusal(str(error), str(path))
        return False
    return True
