"""Differences between a scene and the one in its file."""

from glrt.core.memo import kept_for_the_same
from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml_writer import scene_with
from glrt.settings import Settings

EDITED = (  # to be saved
    *("objects", "materials", "media", "medium", "lights", "background", "sun", "animation"),
)


@kept_for_the_same
def is_edited(saved: Scene, scene: Scene) -> bool:
    """Whether edits of the scene are unsaved; its camera and settings do not count."""
    return any(getattr(saved, part) != getattr(scene, part) for part in EDITED)


@kept_for_the_same
def is_other(written: Scene, scene: Scene, settings: Settings) -> bool:
    """Whether scene, camera or settings differ from the scene that is in the file."""
    whole = scene_with(scene, settings)
    return is_edited(written, scene) or any(
        getattr(written, part) != getattr(whole, part) for part in ("camera", "render")
    )
