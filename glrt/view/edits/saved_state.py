"""Whether a scene has edits that are not saved."""

from glrt.core.memo import kept_for_the_same
from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml_writer import scene_with
from glrt.settings import Settings

EDITED = ("objects", "materials", "media", "medium", "lights", "background", "sun")  # to be saved


@kept_for_the_same
def is_other(written: Scene, scene: Scene, settings: Settings) -> bool:
    """Whether a save would write another scene, camera or settings than the file has."""
    whole = scene_with(scene, settings)
    return differs(written, scene) or any(
        getattr(written, part) != getattr(whole, part) for part in ("camera", "render")
    )


@kept_for_the_same
def differs(saved: Scene, scene: Scene) -> bool:
    """Whether a scene has edits of parts that a user would miss; a camera is no such part."""
    return any(getattr(saved, part) != getattr(scene, part) for part in EDITED)
