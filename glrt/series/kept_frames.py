"""Frames that were rendered before: each counts if its recipe is the one that is wanted."""

from pathlib import Path

from glrt.core.errors import GlrtError
from glrt.core.version import VERSION
from glrt.image.image import read_recipe
from glrt.image.picture_files import check_pixels
from glrt.image.recipe import FrameLimits
from glrt.scene.loading.scene_files import hashes_of
from glrt.scene.scenefile.toml import scene_to_dict
from glrt.series.series import Still
from glrt.settings import Settings

_OF_DISPLAY = ("exposure", "tonemap")  # settings that an .exr does not hold


def kept(file: Path, still: Still, limits: FrameLimits) -> FrameLimits | None:
    """Return the record of a complete frame with this scene, settings and limits.

    None if the file is missing or damaged, or holds another picture.
    """
    if not file.exists():
        return None
    try:
        recipe = read_recipe(file)
        check_pixels(file)
    except GlrtError:
        return None
    frame = recipe.frame
    if frame is None or frame.model_copy(update={"reached": True}) != limits:
        return None
    is_exr = file.suffix.lower() == ".exr"
    is_same = (
        recipe.version == VERSION
        and _without_display(recipe.settings, is_exr) == _without_display(still.settings, is_exr)
        and recipe.assets == hashes_of(still.scene)
        and scene_to_dict(recipe.scene) == scene_to_dict(still.scene)
    )
    return frame if is_same else None


def _without_display(settings: Settings, is_exr: bool) -> Settings:
    return settings.model_copy(update=dict.fromkeys(_OF_DISPLAY, 0)) if is_exr else settings
