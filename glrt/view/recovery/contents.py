"""The scene in a recovery file: the text that a save writes, without copies of its files."""

from collections.abc import Collection, Iterator
from pathlib import Path

from glrt.scene.files.assets import AssetFolder
from glrt.scene.files.named_grids import SUFFIXES as GRIDS
from glrt.scene.files.named_grids import GridFile
from glrt.scene.files.named_images import ImageFile, TextureImage
from glrt.scene.files.named_meshes import MeshFile
from glrt.scene.loading.file_contents import NamedContent
from glrt.scene.loading.scene_files import (
    hashes_of,
    named_files,
    with_files,
    with_files_of,
    with_hashes,
)
from glrt.scene.model_scene import model_scene
from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml import read_scene
from glrt.scene.schema.tables import toml_text
from glrt.view.edits.grid_files import with_grid_read
from glrt.view.edits.sky_images import SKIES, with_sky_image
from glrt.view.edits.texture_images import TEXTURES, with_image_read
from glrt.view.recovery.headers import Header


def text_of(header: Header, scene: Scene) -> str:
    """Return the content of a recovery file, which is a scene file with a comment above."""
    return header.line() + toml_text(scene)


def scene_of(file: Path, header: Header, saved: Scene, folder: AssetFolder) -> Scene:
    """Return the scene in a recovery file, with the content of its files.

    `saved` is the scene without the edits, whose files are not read again. Others lie in `folder`,
    or are those of models, images or grids that were added. Raises `SceneError` if one is wrong or
    missing.
    """
    scene = _with_content_of(read_scene(file), saved)
    for name in header.models:
        added = Path(name)
        if added.suffix.lower() in SKIES:
            scene = _with_content_of(scene, with_sky_image(saved, added))
        elif added.suffix.lower() in TEXTURES:
            scene = _with_content_of(scene, with_image_read(saved, added))
        elif added.suffix.lower() in GRIDS:
            scene = _with_content_of(scene, with_grid_read(saved, added))
        else:
            scene = _with_content_of(scene, model_scene(added, AssetFolder(added.parent), name))
    return with_files(scene, folder, str(file))


def _with_content_of(scene: Scene, other: Scene) -> Scene:
    """Return the scene with the content of the files that another one has read."""
    return with_files_of(with_hashes(scene, hashes_of(other)), other)


def added_models(scene: Scene, saved: Scene) -> tuple[str, ...]:
    """Return the paths of models, images and grids that the saved scene does not name."""
    known = {named for _, named in named_files(saved)}
    return tuple(dict.fromkeys(_origins(scene, known)))


def _origins(scene: Scene, known: Collection[object]) -> Iterator[str]:
    for _, named in named_files(scene):
        is_own = isinstance(named, MeshFile | ImageFile | GridFile) or _was_dropped(named)
        if is_own and named.origin and named not in known:
            yield str(named.origin)


def _was_dropped(named: NamedContent) -> bool:
    """Whether a file is an image on its own; those of a model come with it."""
    is_alone = named.origin is not None and named.origin.name == named.file
    return isinstance(named, TextureImage) and is_alone
