"""How many images, textures and blocks a kernel declares, for a scene with one of each thing.

Drivers refuse more than they grant, and they differ: Mesa grants a compute shader 32 images,
NVIDIA's driver 8. OpenGL 4.3 promises these numbers for compute shaders, and 4.1 for fragment
shaders. Textures are the exception: OpenGL promises 16, which one of each thing exceeds,
and the drivers of AMD, Intel and NVIDIA grant 32.
"""

import re

import pytest

from glrt.rendering import passes
from glrt.rendering.passes import RenderPass, Resolved, aov_pass
from glrt.rendering.pipelines import sources
from glrt.settings import TERMS
from tests.support.builders import FEATURE_SETS
from tests.support.kernel_text import written_for_everything

PASSES = {name: each for name, each in vars(passes).items() if isinstance(each, RenderPass)}
PASSES |= {"AOVS": aov_pass(("albedo", "normal")), "TERMS": aov_pass(TERMS)}
DECLARED = {
    "images": r"^ *(?:layout\(\w+\) )?uniform [^;{(]*\b[iu]?image2D\b",
    "textures": r"^ *uniform [^;{(]*\b[iu]?sampler\w+",
    "storage blocks": r"\bbuffer \w+ *\{",
    "uniform blocks": r"\buniform \w+ *\{",
}
GRANTED: dict[Resolved, dict[str, int]] = {
    "compute": {"images": 8, "textures": 32, "storage blocks": 8, "uniform blocks": 14},
    "fragment": {"images": 0, "textures": 32, "storage blocks": 0, "uniform blocks": 12},
}
KERNELS = [(name, way) for name, each in PASSES.items() for way in each.shaders]


@pytest.mark.parametrize(("name", "pipeline"), KERNELS)
def test_a_kernel_declares_no_more_than_drivers_grant(name: str, pipeline: Resolved) -> None:
    shaders = sources(pipeline, FEATURE_SETS["everything"], written_for_everything(), PASSES[name])
    for shader in shaders:
        for kind, pattern in DECLARED.items():
            count = len(re.findall(pattern, shader.whole.text, re.MULTILINE))
            assert count <= GRANTED[pipeline][kind], kind
        assert re.search(DECLARED["uniform blocks"], shader.whole.text)


def test_declarations_are_counted() -> None:
    """Every kind, in a kernel that has all of them."""
    (kernel,) = sources(
        "compute", FEATURE_SETS["everything"], written_for_everything(), passes.RADIANCE
    )
    counts = {
        kind: len(re.findall(pattern, kernel.whole.text, re.MULTILINE))
        for kind, pattern in DECLARED.items()
    }
    assert counts["images"] == 8
    assert counts["storage blocks"] == 1
    assert counts["textures"] > 20
    assert counts["uniform blocks"] > 5
