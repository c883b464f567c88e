"""The kernels of probes, and kernels that read probes, as the driver sees them."""

import moderngl
import pytest

from glrt.rendering.passes import (
    PROBE_DISTANCES,
    PROBE_LIGHT,
    PROBE_PLACES,
    PROBE_RAYS,
    RADIANCE,
    RenderPass,
)
from glrt.rendering.pipelines import sources
from tests.gpu.test_precise import computed_returns, imprecise
from tests.support.builders import FEATURE_SETS
from tests.support.driver_log import COMPUTE, warnings
from tests.support.kernel_text import written_for

PASSES = {
    "rays": PROBE_RAYS,
    "light": PROBE_LIGHT,
    "distances": PROBE_DISTANCES,
    "places": PROBE_PLACES,
    "picture": RADIANCE,
}


@pytest.mark.slow_cases("everything-*")
@pytest.mark.parametrize("render_pass", PASSES.values(), ids=PASSES)
@pytest.mark.parametrize("features", ["everything", "nothing"])
def test_kernels_of_probes_compile_without_a_warning(
    ctx: moderngl.Context, features: str, render_pass: RenderPass
) -> None:
    assert ctx.version_code >= 430
    reuse = {"RESAMPLES": True, "REUSES_OWN": True, "REUSES_NEAR": 2, "UNBIASED": True}
    constants = {**FEATURE_SETS[features], "HAS_PROBES": True, **reuse}
    (compute,) = sources("compute", constants, written_for(), render_pass)
    assert imprecise(compute.whole.text) == []
    assert computed_returns(compute.whole.text) == []
    assert warnings((COMPUTE, compute.live.text)) == []
