"""A rendered image and its files: EXR, PNG and NPY, each written whole or not at all."""

import io
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from glrt import files
from glrt.error.estimate import relative_error
from glrt.error.reliability import is_doubtful
from glrt.errors import SceneError, UsageError
from glrt.image import aovs, particle_film
from glrt.image.aovs import AovImages
from glrt.image.film_state import FilmState, from_channels, to_channels
from glrt.image.particle_film import ParticleFilm
from glrt.image.recipe import Recipe
from glrt.image.tonemap import expose_and_encode
from glrt.settings import Aov, Settings, ToneMap
from glrt.silence import silenced
from glrt.text import escaped

Pixels = NDArray[np.float32]

SUFFIXES = (".exr", ".png", ".npy")
MOST_PIXELS = 16384**2  # of the largest frame
RECIPE_KEY = "glrt"  # of the EXR attribute and of the PNG chunk

_EXR_MAGIC = b"\x76\x2f\x31\x01"


@dataclass(frozen=True, eq=False)
class Image:
    """Radiance in linear sRGB, (H, W, 3) float32, row 0 on top, with its standard error.

    `stderr`, of the same shape, is the standard error of each mean: all NaN for fewer than two
    observations. `samples` a pixel were taken; 0 if the image is not glrt's: then it has no
    recipe. `film_state` is what a render needs to continue from it, if that is known; `particles`
    are the two films of which a picture with particles is the sum. `aovs` are those that the
    settings asked for, by name. Raises ValueError for arrays of another shape or type.
    """

    radiance: Pixels
    stderr: Pixels
    samples: int
    recipe: Recipe | None = None
    film_state: FilmState | None = None
    aovs: AovImages = field(default_factory=dict)
    particles: ParticleFilm | None = None

    def __post_init__(self) -> None:
        for pixels in (self.radiance, self.stderr):
            if pixels.dtype != np.float32 or pixels.ndim != 3 or pixels.shape[2] != 3:
                raise ValueError(f"not an image: {pixels.dtype} of shape {pixels.shape}")
        if self.radiance.shape != self.stderr.shape:
            raise ValueError("radiance and stderr differ in shape")

    @property
    def error(self) -> float | None:
        """Estimated relative RMS error, of the noise alone; None if it is unknown."""
        return relative_error(self.radiance, self.stderr)

    @property
    def error_doubtful(self) -> bool | None:
        """Whether `error` is not to be believed: it may hang on a few pixels that few samples lit.

        None where that cannot be judged: with fewer than four observations, without a recipe, or
        where the light was changed in the window.
        """
        if self.recipe is None or self.recipe.traced is not None:
            return None
        observations = self.samples // self.recipe.settings.block
        return is_doubtful(self.radiance, self.stderr, observations)

    def with_aovs(self, names: tuple[Aov, ...]) -> "Image":
        """The picture with these of its AOVs alone."""
        if not self.recipe or self.recipe.settings.aov == names:
            return self
        settings = self.recipe.settings.model_copy(update={"aov": names})
        recipe = self.recipe.model_copy(update={"settings": settings})
        return replace(self, recipe=recipe, aovs={name: self.aovs[name] for name in names})

    def save(
        self,
        path: str | Path,
        exposure: float | None = None,
        tonemap: ToneMap | None = None,
    ) -> None:
        """Write an EXR, PNG or NPY file, by suffix.

        `exposure` in EV and `tonemap` apply to PNG alone, by default those of the recipe. Raises
        `UsageError` for another suffix, `RenderError` if the file cannot be written; an existing
        file is then unchanged.
        """
        writers: dict[str, Callable[[Path], None]] = {
            ".exr": self._write_exr,
            ".png": lambda file: self._write_png(file, exposure, tonemap),
            ".npy": lambda file: np.save(file, self.radiance),
        }
        files.write_whole(Path(path), writers[_known_suffix(Path(path))])

    @classmethod
    def load(cls, path: str | Path) -> "Image":
        """Read an EXR file of glrt, or of another program with channels R, G and B.

        The latter has no recipe, 0 samples, and NaN for `stderr`. Raises `UsageError` if there is
        no such image, `SceneError` for a damaged recipe.
        """
        header, channels = _read_exr(Path(path))
        radiance = _stacked(channels, "")
        if radiance is None:
            names = ", ".join(sorted(channels)[:12])
            raise UsageError(
                f"{path}: an image needs channels R, G and B of one size; has {names}."
            )
        stderr = _stacked(channels, "stderr.")
        if stderr is None or stderr.shape != radiance.shape:
            stderr = np.full_like(radiance, np.nan)
        recipe = _parsed(header.get(RECIPE_KEY), path)
        if recipe is None:
            return cls(radiance, stderr, 0)
        film = from_channels(channels, stderr, recipe.samples, recipe.settings.block)
        found = aovs.from_channels(channels, recipe.settings.aov)
        two = particle_film.from_channels(channels, radiance.shape[:2])
        return cls(radiance, stderr, recipe.samples, recipe, film, found, two)

    def _write_exr(self, path: Path) -> None:
        import OpenEXR  # type: ignore[import-not-found]

        header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
        if self.recipe:
            header[RECIPE_KEY] = self.recipe.to_json()
        channels: dict[str, NDArray[Any]] = {"RGB": self.radiance, "stderr": self.stderr}
        if self.recipe and self.film_state:
            block = self.recipe.settings.block
            channels |= to_channels(self.film_state, self.stderr, self.samples, block)
        if self.particles:
            channels |= particle_film.to_channels(self.particles)
        channels |= aovs.to_channels(self.aovs)
        # OpenEXR scrambles arrays that are not contiguous, without a word.
        contiguous = {name: np.ascontiguousarray(pixels) for name, pixels in channels.items()}
        name = str(path)
        name.encode()  # of another name the library says something else
        OpenEXR.File(header, contiguous).write(name)

    def _write_png(
        self,
        file: Path | IO[bytes],
        exposure: float | None = None,
        tonemap: ToneMap | None = None,
    ) -> None:
        from PIL import Image as Pillow
        from PIL.PngImagePlugin import PngInfo

        settings = self.recipe.settings if self.recipe else Settings()
        exposure = settings.exposure if exposure is None else exposure
        codes = expose_and_encode(self.radiance, exposure, tonemap or settings.tonemap)
        metadata = PngInfo()
        metadata.add(b"sRGB", b"\x00")
        if self.recipe:
            metadata.add_itxt(RECIPE_KEY, self.recipe.to_json())
        Pillow.fromarray(codes).save(file, format="PNG", pnginfo=metadata)

    def _repr_png_(self) -> bytes:
        """The picture as notebooks show it."""
        file = io.BytesIO()
        self._write_png(file)
        return file.getvalue()


def read_recipe(path: str | Path) -> Recipe:
    """The recipe of an EXR or PNG file, without its pixels.

    Raises `UsageError` if there is none, `SceneError` if it is damaged.
    """
    path = Path(path)
    if path.suffix.lower() == ".png":
        text = _read_png_metadata(path).get(RECIPE_KEY)
    else:
        text = _read_exr(path, header_only=True)[0].get(RECIPE_KEY)
    recipe = _parsed(text, path)
    if recipe is None:
        raise UsageError(
            f"{path}: this picture has no recipe: glrt did not render it, or another program "
            "saved it again. Give the scene file instead."
        )
    return recipe


def check_writable(path: str | Path) -> None:
    """Raise `UsageError` if `Image.save` could not write there; leaves nothing behind."""
    if _known_suffix(Path(path)) == ".exr":
        _check_name(Path(path))
    files.check_writable(Path(path))


def _known_suffix(path: Path) -> str:
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise UsageError(
            f"Cannot write {path}: the name of an image must end in .exr, .png or .npy."
        )
    return suffix


def _read_exr(path: Path, header_only: bool = False) -> tuple[Mapping[str, Any], Mapping[str, Any]]:
    """Header and channels by name, (H, W) each."""

    if _first_bytes(path) != _EXR_MAGIC:
        raise UsageError(f"{path}: not an EXR image, despite its name; give one that is.")
    header, channels = _opened_exr(path, True, "its header is damaged")
    if not header_only:
        _check_size(header["dataWindow"], path)
        header, channels = _opened_exr(path, False, "its pixels are damaged, or it is cut off")
    return header, channels


def _opened_exr(
    path: Path, header_only: bool, damage: str
) -> tuple[Mapping[str, Any], Mapping[str, Any]]:
    """Header and channels; the library's own words say nothing of what is wrong."""
    import OpenEXR

    _check_name(path)
    try:
        with silenced():
            file = OpenEXR.File(str(path), separate_channels=True, header_only=header_only)
            channels = {name: channel.pixels for name, channel in file.channels().items()}
            return file.header(), channels
    except UnicodeError as error:
        raise _unreadable(path, error) from None
    except (RuntimeError, ValueError):
        advice = "Copy it or render it again."
        raise UsageError(f"{path}: cannot read this image: {damage}. {advice}") from None


def _check_name(path: Path) -> None:
    """Raise UsageError for a name of an EXR file that the library does not take."""
    try:
        str(path.absolute()).encode()
    except UnicodeError:
        advice = "OpenEXR takes only names in UTF-8; rename the file or its folder."
        raise UsageError(f"{escaped(str(path))}: {advice}") from None


def _check_size(window: Any, path: Path) -> None:
    """Raise UsageError for a picture that no memory holds, as a few bytes can claim to be."""
    low, high = (np.asarray(corner, float) for corner in window)
    width, height = high - low + 1
    if width * height > MOST_PIXELS:
        raise UsageError(
            f"{path}: {width:.0f} x {height:.0f} pixels are more than glrt reads, {MOST_PIXELS:,}."
        )


def _first_bytes(path: Path) -> bytes:
    try:
        files.check_regular(path)
        with path.open("rb") as file:
            return file.read(len(_EXR_MAGIC))
    except OSError as error:
        raise _unreadable(path, error) from None


def _read_png_metadata(path: Path) -> Mapping[Any, Any]:
    from PIL.PngImagePlugin import PngImageFile

    try:
        files.check_regular(path)
        with PngImageFile(path) as file:
            return file.info
    except (OSError, SyntaxError, ValueError) as error:
        raise _unreadable(path, error) from None


def _unreadable(path: Path, error: BaseException) -> UsageError:
    return UsageError(
        f"{path}: cannot read this image: {files.reason(error)}. Check name and file."
    )


def _stacked(channels: Mapping[str, Any], prefix: str) -> Pixels | None:
    """R, G, B as (H, W, 3) float32; None if one is missing, of another size, or deep."""
    planes = [channels[prefix + name] for name in "RGB" if prefix + name in channels]
    shapes = {plane.shape for plane in planes}
    if len(planes) < 3 or len(shapes) > 1 or any(plane.dtype == object for plane in planes):
        return None
    return np.stack(planes, axis=-1).astype(np.float32, copy=False)


def _parsed(text: object, path: str | Path) -> Recipe | None:
    if text is None:
        return None
    if not isinstance(text, str):
        raise SceneError(f"{path}: the recipe in this picture is damaged: it is not a text.")
    return Recipe.from_json(text, str(path))
