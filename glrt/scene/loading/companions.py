"""Files that a file names by their paths from it; glTF and converted files, each parsed once."""

from glrt.core.errors import SceneError
from glrt.core.text import quoted
from glrt.scene.files.assets import Asset, AssetReader, folder_of
from glrt.scene.files.path_text import name_of
from glrt.scene.model_files.conversion.document import ConvertedDocument
from glrt.scene.model_files.conversion.process import ConversionError, library_of
from glrt.scene.model_files.gltf.document import Document


class Beside:
    """Reads files by their paths from another one."""

    def __init__(self, asset: Asset, reader: AssetReader, where: str) -> None:
        """Read files by their paths from an asset; messages begin with `where`."""
        self._asset, self._reader, self._where = asset, reader, where
        self._hashes: dict[str, str] = {}

    def __call__(self, path: str) -> bytes:
        """Return the content of the file at a path; raises `SceneError`."""
        spelled = self._reader.spelled(path, folder_of(self._asset.path))
        where, file = self._where, self._asset.path
        is_named = f"/{where}".endswith(f"/{file}")  # as where a model is all of the scene
        found = self._reader.read(spelled, where if is_named else f"{where}: {file}")
        self._hashes[found.path] = found.sha256
        return found.content

    @property
    def hashes(self) -> dict[str, str]:
        """SHA-256 by path of the files read so far, by all that read the same asset as glTF."""
        return dict(self._hashes)

    def document(self) -> Document:
        """Return the asset as a glTF file, parsed once for a reader; ValueError for mistakes.

        A USD or MaterialX file is converted; `SceneError` if it cannot be.
        """
        made = self._reader.made
        if self._asset.path not in made:
            made[self._asset.path] = self._parsed(), self
        document, first = made[self._asset.path]
        first._where, self._hashes = self._where, first._hashes
        found: Document = document
        return found

    def _parsed(self) -> Document:
        path, folder = self._asset.path, self._reader.folder
        library = library_of(path)
        if library is None:
            return Document(self._asset.content, self)
        try:
            file = folder.base / name_of(path)
            return ConvertedDocument(library, file, folder.base, folder.allow_outside, self)
        except ConversionError as error:
            raise SceneError(f"{self._where}: {quoted(path)} {error}.") from None
