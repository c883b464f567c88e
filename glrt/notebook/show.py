"""`glrt.show`: a live picture in a notebook."""

from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

from glrt.core.errors import UsageError
from glrt.core.install import install
from glrt.notebook.live import HABITS, Live
from glrt.notebook.sources import scene_of
from glrt.scene.scene import Scene
from glrt.setting_options import SettingOptions
from glrt.settings import Settings, settings_for

if TYPE_CHECKING:
    from glrt.notebook.widget import LivePicture

EDGE = 480  # pixels: longer edge of a picture, where the user gives no size
REFUSED = ("crop", "aov", "denoise")  # settings that a live picture does without
EXTRA = ("anywidget", "traitlets")  # modules that the extra `notebook` installs


def show(
    source: Scene | str | Path | Any,
    faces: Any = None,
    *,
    error: float = HABITS.target_error,
    **settings: Unpack[SettingOptions],
) -> "LivePicture":
    """Return a live picture for a notebook, which a cell shows if it is its last value.

    `source` is a Scene, a path or name as `glrt.load` takes it, a mesh or scene of trimesh, or an
    array of vertices, (v, 3), with `faces`, (n, 3). A mesh stands in a studio; colours of its
    vertices are kept, its textures are not. `settings` are fields of Settings except `crop`, `aov`
    and `denoise`; the scene's `[render]` table supplies the others, and its size is reduced to 480
    pixels along the longer edge where neither `width` nor `height` is given. `error` is the
    relative error that the forecast is for.

    The picture gets samples while a page shows it. All pictures of a process share an OpenGL
    context. `scene` and `settings` of the result are those at present, `image()` is the picture so
    far, `close()` ends it. Needs the extra `notebook`.

    Raises UsageError without that, for a wrong source and for a setting out of range, and the
    errors of `glrt.load`. The picture itself reports where OpenGL is missing.
    """
    if refused := sorted({*settings} & {*REFUSED}):
        raise UsageError(
            f"show does without {', '.join(refused)}: render the scene with glrt.render instead."
        )
    if not 0 < error <= 1:
        raise UsageError(f"the error of the forecast must be above 0 and at most 1, got {error}.")
    scene = scene_of(source, faces)
    live = Live(scene, shown_settings(scene, settings), error)
    try:
        from glrt.notebook.widget import LivePicture
    except ModuleNotFoundError as missing:
        if missing.name not in EXTRA:
            raise
        raise UsageError(
            f"show needs the Python package {missing.name}: type `{install('notebook')}` "
            "and start the kernel again. `glrt.render` needs no package, and its pictures show "
            "themselves in notebooks."
        ) from None
    return LivePicture(live, scene.title or "picture of a scene")


def shown_settings(scene: Scene, given: SettingOptions) -> Settings:
    """Return the settings of a live picture; UsageError for one out of range."""
    wanted = settings_for(scene.render, **given)
    scale = EDGE / max(wanted.width, wanted.height)
    if scale >= 1 or {"width", "height"} & {*given}:
        return wanted
    width, height = (max(1, round(scale * side)) for side in (wanted.width, wanted.height))
    return settings_for(wanted, width=width, height=height)
