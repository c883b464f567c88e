"""The shader file that is written for a scene, as the kernel of each tier gets it."""

import numpy as np

from glrt.gpu.struct_arrays import FILE, MOST_UNIFORM_BYTES
from glrt.image.sources import load
from glrt.rendering.pipelines import Tier, text_of
from glrt.rendering.shader_functions import no_rows
from tests.support.packed import packed


def written_for(
    scene: str = "cornell", tier: Tier = "generic", uniform_bytes: int = MOST_UNIFORM_BYTES
) -> dict[str, str]:
    """The text by its name, as `Source` takes it."""
    return {FILE: text_of(packed(load(scene)), tier, uniform_bytes)}


def written_for_everything() -> dict[str, str]:
    """The text for a scene with one of each thing: no part is left out as unused."""
    rows = {name: np.zeros(1, empty.dtype) for name, empty in no_rows().items()}
    return {FILE: text_of(rows, "generic", MOST_UNIFORM_BYTES)}
