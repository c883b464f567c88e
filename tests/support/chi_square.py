"""Whether samples of a material follow the density that it reports."""

from typing import Any

import numpy as np

from tests.conftest import CallGlsl
from tests.shaders.test_sampling import DRAWS, RNG, cells_of
from tests.support.alarms import assert_fits
from tests.support.numerics import wo_at


def assert_density(
    call_glsl: CallGlsl,
    setup: str,
    given: dict[str, Any],
    cosine: float,
    grid: tuple[int, int],
    fine: int,
    lowest: float,
) -> None:
    """Chi-square over cells of height (from `lowest` to 1) and azimuth, and of what is absorbed.

    `setup` declares the `Vertex vertex` for `wo`; the density is summed at fine^2 points of a cell.
    """
    rows, columns = grid
    cell = np.arange(rows * columns)
    sums = f"""
        float sum = 0.0;
        for (int k = 0; k < {fine * fine}; ++k) {{
            vec2 middle = vec2(float(k % {fine}) + 0.5, float(k / {fine}) + 0.5) / {fine}.0;
            float z = {lowest} + {1 - lowest} * (float(row) + middle.x) / {rows}.0;
            float phi = 2.0 * PI * (float(column) + middle.y) / {columns}.0;
            vec3 wi = vec3(sqrt(1.0 - z * z) * vec2(cos(phi), sin(phi)), z);
            sum += pdf_material(vertex, wi);
        }}"""
    wo = np.repeat(wo_at(cosine), len(cell), axis=0)
    row, column = np.divmod(cell, columns)
    share = call_glsl("sum", setup=setup + sums, wo=wo, row=row, column=column, **given)
    share = share.astype(np.float64) * 2 * np.pi * (1 - lowest) / (rows * columns * fine * fine)
    assert share.sum() < 1 + 2e-3
    sampled = RNG + setup + "Scattering next = sample_material(vertex, rng);"
    wo = np.repeat(wo_at(cosine), DRAWS, axis=0)
    drawn = call_glsl("vec4(next.direction, next.pdf)", "vec4", setup=sampled, wo=wo, **given)
    kept = drawn[:, 3] > 0
    counts = np.append(cells_of(drawn[kept, :3], rows, columns, lowest), np.count_nonzero(~kept))
    assert_fits(counts, DRAWS * np.append(share, max(1 - share.sum(), 0)))
