"""A rendered image and its files: EXR, PNG and NPY, each written whole or not at all."""

import io
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from glrt.core import files
from glrt.core.errors import SceneError, UsageError
from glrt.denoise.denoising import Denoised
from glrt.error.estimate import estimated_error
from glrt.error.reliability_of_scene import judged
from glrt.image import aovs, denoised_channels, particle_film
from glrt.image.aovs import AovImages
from glrt.image.film_state import FilmState, from_channels, to_channels
from glrt.image.layer_sums import LayerSums
from glrt.image.particle_film import ParticleFilm
from glrt.image.picture_files import exr_name, read_exr, read_png_metadata
from glrt.image.recipe import Recipe
from glrt.image.tonemap import expose_and_encode
from glrt.settings import Aov, Settings, ToneMap

Pixels = NDArray[np.float32]

SUFFIXES = (".exr", ".png", ".npy")
RECIPE_KEY = "glrt"  # name of the EXR attribute and of the PNG chunk


@dataclass(frozen=True, eq=False)
class Image:
    """Radiance in linear sRGB, (H, W, 3) float32, row 0 on top, with its standard error.

    `stderr`, of the same shape, is the standard error of each mean: all NaN for fewer than two
    observations. `samples` were taken per pixel, or on average (`counts`); an image of another
    program has 0 samples and no recipe. `film_state` is what a render needs to continue, if it is
    known. `particles` are two films whose sum is a picture with particles. `aovs` are the requested
    AOVs, by name, and the objects of pixels that share random numbers. `denoising` is the filtered
    picture, if it was requested. `sums` are the sums of a film with layers, for a denoiser; files
    do not hold them. Raises ValueError for arrays of another shape or type.
    """

    radiance: Pixels
    stderr: Pixels
    samples: int
    recipe: Recipe | None = None
    film_state: FilmState | None = None
    aovs: AovImages = field(default_factory=dict)
    particles: ParticleFilm | None = None
    denoising: Denoised | None = None
    sums: LayerSums | None = None

    def __post_init__(self) -> None:
        for pixels in (self.radiance, self.stderr):
            if pixels.dtype != np.float32 or pixels.ndim != 3 or pixels.shape[2] != 3:
                raise ValueError(f"not an image: {pixels.dtype} of shape {pixels.shape}")
        if self.radiance.shape != self.stderr.shape:
            raise ValueError("radiance and stderr differ in shape")

    @property
    def counts(self) -> NDArray[np.int32]:
        """Samples taken of each pixel, (H, W) int32; their mean is `samples`, up to whole blocks.

        All are equal, unless the picture is adaptive. Without its film state they are unknown, and
        `samples`.
        """
        if self.film_state and self.film_state.counts.size:
            return self.film_state.counts
        return np.full(self.radiance.shape[:2], self.samples, np.int32)

    @property
    def error(self) -> float | None:
        """Estimated relative RMS error, from the noise alone; None if it is unknown."""
        return estimated_error(self.radiance, self.stderr)

    def denoised(self) -> Denoised:
        """The filtered picture with its error; UsageError if `denoise` did not ask for it."""
        if self.denoising is None:
            raise UsageError(
                "this picture was not denoised: render it with denoise='auto', and as many samples "
                "as that needs"
            )
        return self.denoising

    @property
    def shown(self) -> Pixels:
        """The pixels of PNG and NPY files: the radiance, denoised if that was requested."""
        return self.radiance if self.denoising is None else self.denoising.radiance

    @property
    def error_to_reach(self) -> float | None:
        """The error that is compared with a wanted error; None if it is unknown.

        It is the estimate; for a denoised picture, whose estimate is rough, its upper limit.
        """
        return self.error if self.denoising is None else self.denoising.error_high

    @property
    def error_doubtful(self) -> bool | None:
        """Whether `error` is doubtful: it may depend on a few pixels that few samples lit.

        None if that cannot be judged: with fewer than four observations, without a recipe, or if
        the light was changed in the window.
        """
        if self.recipe is None or self.recipe.traced is not None:
            return None
        recipe = self.recipe
        return judged(recipe.scene, recipe.settings, self.samples, self.radiance, self.stderr)

    def with_aovs(self, names: tuple[Aov, ...]) -> "Image":
        """The picture with only these of its AOVs."""
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

        `exposure` in EV and `tonemap` apply to PNG alone; by default they are those of the recipe.
        Raises `UsageError` for another suffix, or for an EXR name that is not UTF-8. Raises
        `RenderError` if the file cannot be written; an existing file is then unchanged.
        """
        writers: dict[str, Callable[[Path], None]] = {
            ".exr": self._write_exr,
            ".png": lambda file: self._write_png(file, exposure, tonemap),
            ".npy": lambda file: np.save(file, self.shown),
        }
        files.write_whole(Path(path), writers[_suffix_to_write(Path(path))])

    @classmethod
    def load(cls, path: str | Path) -> "Image":
        """Read an EXR file of glrt, or of another program with channels R, G and B.

        An image of another program has no recipe, 0 samples, and NaN for `stderr`. Raises
        `UsageError` if there is no such image, `SceneError` for a damaged recipe.
        """
        header, channels = read_exr(Path(path))
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
        settings = recipe.settings
        film = from_channels(
            channels, stderr, recipe.samples, settings.block, groups=settings.division.groups
        )
        found = aovs.from_channels(channels, settings.kept)
        two = particle_film.from_channels(channels, radiance.shape[:2])
        shown = denoised_channels.from_channels(header, channels, radiance.shape[:2])
        return cls(radiance, stderr, recipe.samples, recipe, film, found, two, shown)

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
        if self.denoising:
            channels |= denoised_channels.to_channels(self.denoising)
            header |= denoised_channels.to_attributes(self.denoising)
        # OpenEXR scrambles arrays that are not contiguous, without an error.
        contiguous = {name: np.ascontiguousarray(pixels) for name, pixels in channels.items()}
        OpenEXR.File(header, contiguous).write(exr_name(path))

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
        codes = expose_and_encode(self.shown, exposure, tonemap or settings.tonemap)
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
    """Read the recipe of an EXR or PNG file, without its pixels.

    Raises `UsageError` if there is none, `SceneError` if it is damaged.
    """
    path = Path(path)
    if path.suffix.lower() == ".png":
        text = read_png_metadata(path).get(RECIPE_KEY)
    else:
        text = read_exr(path, header_only=True)[0].get(RECIPE_KEY)
    recipe = _parsed(text, path)
    if recipe is None:
        raise UsageError(
            f"{path}: this picture has no recipe: glrt did not render it, or another program "
            "saved it again. Give the scene file instead."
        )
    return recipe


def check_writable(path: str | Path) -> None:
    """Raise `UsageError` if `Image.save` could not write there; leaves nothing behind."""
    if not str(path):
        raise UsageError("-o has an empty name: name a file that ends in .exr, .png or .npy.")
    _suffix_to_write(Path(path))
    files.check_writable(Path(path))


def _suffix_to_write(path: Path) -> str:
    """The suffix of a path; UsageError for an unknown one, or for a name that OpenEXR refuses."""
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise UsageError(
            f"Cannot write {path}: the name of an image must end in .exr, .png or .npy."
        )
    if suffix == ".exr":
        exr_name(path.absolute())
    return suffix


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
