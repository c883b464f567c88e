"""Files that a file names by their paths from it, and glTF files, each parsed once."""

from glrt.scene.files.assets import Asset, AssetReader, folder_of
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
        found = self._reader.read(spelled, f"{self._where}: {self._asset.path}")
        self._hashes[found.path] = found.sha256
        return found.content

    @property
    def hashes(self) -> dict[str, str]:
        """SHA-256 by path of the files read so far, by all that read the same asset as glTF."""
        return dict(self._hashes)

    def document(self) -> Document:
        """Return the asset as a glTF file, parsed once for a reader; ValueError for mistakes."""
        made = self._reader.made
        if self._asset.path not in made:
            made[self._asset.path] = Document(self._asset.content, self), self
        document, first = made[self._asset.path]
        first._where, self._hashes = self._where, first._hashes
        found: Document = document
        return found
