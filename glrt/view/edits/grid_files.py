"""Grids of densities from files that become the density of a medium."""

from pathlib import Path

from glrt.core.errors import SceneError, UsageError
from glrt.scene.density import Density
from glrt.scene.files.assets import AssetFolder, AssetReader
from glrt.scene.files.named_grids import GridFile
from glrt.scene.files.path_text import text_of
from glrt.scene.loading.file_contents import with_content
from glrt.scene.loading.scene_files import placing_problems
from glrt.scene.medium import Medium
from glrt.scene.scene import Scene
from glrt.view.controls import made
from glrt.view.edits.media_edits import with_medium

_USUAL = "density"  # name of the grid of densities in files that hold several


def with_grid_file(scene: Scene, name: str, path: Path) -> Scene:
    """Return the scene in which a grid from a file is the density of a medium.

    Its densest voxel is as dense as an even medium was. A save copies the file next to the scene
    file. Raises `SceneError` if it is no grid, `UsageError` if it has no place: the medium
    fills an object without an end.
    """
    file, before = grid_in(path), scene.media[name].density
    scale = before.scale if before else float(f"{1 / (file.most or 1.0):.3g}")
    box = {"min": before.min, "max": before.max} if before else {}
    density = made(Density, {"file": file, "grid": file.grid, "scale": scale, **box})
    found = with_medium(scene, name, density=density)
    if problem := next(placing_problems(found), None):
        raise UsageError(problem)
    return found


def with_grid_read(scene: Scene, path: Path) -> Scene:
    """Return the scene with a medium more that has a grid, as a place of its content."""
    density = made(Density, {"file": (file := grid_in(path)), "grid": file.grid})
    spare = Medium(density=density)
    return scene.model_copy(update={"media": {**scene.media, "": spare}})


def grid_in(path: Path) -> GridFile:
    """Return the grid of a file: the only one, or that of the usual name among several.

    Raises `SceneError` if there is none.
    """
    try:
        return _read(path, None)
    except SceneError as error:
        try:
            return _read(path, _USUAL)
        except SceneError:
            raise error from None


def _read(path: Path, grid: str | None) -> GridFile:
    reader = AssetReader(AssetFolder(path.absolute().parent))
    named = GridFile.model_construct(file=text_of(path.name), sha256=None, grid=grid)
    found = with_content(named, reader, str(path.parent))
    assert isinstance(found, GridFile)
    return found
