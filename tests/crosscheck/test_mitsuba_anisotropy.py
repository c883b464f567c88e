"""Mitsuba's rough metal with two alphas has the densities of glrt's anisotropic metal."""

import json
import subprocess
import sys

import pytest
from numpy.testing import assert_allclose

from glrt.scene.materials.metal import Metal
from tests.conftest import CallGlsl
from tests.shaders.test_anisotropy import SETUP
from tests.shaders.test_principled import upper
from tests.support.builders import scene_of, sphere
from tests.support.system_packages import needs_mitsuba

COUNT = 2000
PROGRAM = """
import json, sys
import mitsuba as mi
mi.set_variant("scalar_rgb")
given = json.load(sys.stdin)
metal = {"type": "roughconductor", "distribution": "ggx", "material": "none"}
bsdf = mi.load_dict({**metal, **given["alphas"]})
found = []
for wo, wi in zip(given["wo"], given["wi"]):
    si = mi.SurfaceInteraction3f()
    si.wi = mi.Vector3f(wo)
    found.append(float(bsdf.pdf(mi.BSDFContext(), si, mi.Vector3f(wi))))
print(json.dumps(found))
"""


@pytest.mark.slow
@pytest.mark.parametrize(("roughness", "anisotropy"), [(0.4, 0.7), (0.2, 0.9), (0.8, 0.3)])
def test_the_densities_of_anisotropic_metal_are_mitsubas(
    call_glsl: CallGlsl, roughness: float, anisotropy: float
) -> None:
    """Both sample visible normals. Values differ: Mitsuba's facets shadow each other apart."""
    needs_mitsuba()
    metal = Metal(color=(1, 1, 1), roughness=roughness, anisotropy=anisotropy)
    wo, wi = upper(COUNT, 1), upper(COUNT, 2)
    alphas = {"alpha_u": metal.alpha * metal.stretch, "alpha_v": metal.alpha}
    asked = {"alphas": alphas, "wo": wo.tolist(), "wi": wi.tolist()}
    run = subprocess.run(
        [sys.executable, "-c", PROGRAM],
        input=json.dumps(asked),
        capture_output=True,
        text=True,
        check=True,
    )
    scene = scene_of([sphere([0, 0, -3], 1, "m")], {"m": metal.model_dump(exclude_none=True)})
    found = call_glsl("pdf_material(vertex, wi)", setup=SETUP, wo=wo, wi=wi, scene=scene)
    assert_allclose(found, json.loads(run.stdout), rtol=2e-3, atol=1e-5)
