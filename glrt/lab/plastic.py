"""White plastic: the light that it keeps at grazing angles."""

from typing import Any

import numpy as np

from glrt.lab.rough_glass import lattice
from glrt.lab.scenes import scene_of, sphere
from glrt.lab.sweep import Lab, Sweep

ROUGHNESS = 0.3
_SAMPLE = """
    mat3 up = frame_around(vec3(0.0, 0.0, 1.0));
    Vertex vertex = vertex_of(up, wo, material_at(0), true);
    Scattering next = sample_principled(vertex, u.x, u.yz);
    float kept = next.weight.x;"""
# The sample implementation of glTF 2.0, appendix B: what is below gets 1 - F at the half vector.
_GLTF = f"""{_SAMPLE}
    vec3 wi = next.direction;
    vec3 h = normalized(wo + wi);
    float reflected = 0.04 + 0.96 * schlick_weight(dot(wo, h));
    float alpha = vertex.material.alpha;
    float facets = reflected * pdf_ggx(alpha, wo, h) * ggx_weight(alpha, wo, wi);
    float value = facets + (1.0 - reflected) * pdf_matte(wi);
    kept = next.pdf > 0.0 ? value / next.pdf : 0.0;"""


def grazing(lab: Lab) -> Sweep:
    """Share of light that white plastic loses or gains."""
    x = [1.0, 0.7, 0.5, 0.3, 0.2, 0.1, 0.05, 0.03, 0.01, 0.003, 0.001]
    count = lab.count(1 << 16, 1 << 15)
    plastic: dict[str, Any] = {"type": "principled", "roughness": ROUGHNESS}
    scene = scene_of([sphere([0, 0, -3], 1, "p")], {"p": plastic})
    ways = {"glrt: the base gets what facets leave": _SAMPLE, "glTF, appendix B": _GLTF}
    errors: dict[str, list[float]] = {name: [] for name in ways}
    for cosine in x:
        wo = np.tile([np.sqrt(1 - cosine**2), 0, cosine], (count, 1))
        for name, setup in ways.items():
            kept = lab.path("kept", {"u": lattice(count), "wo": wo}, scene=scene, setup=setup)
            errors[name].append(abs(float(kept.astype(np.float64).mean()) - 1))
    first, *others = errors.items()
    return Sweep(
        parameter="cosine of the angle to the normal",
        measure="light lost or gained\n(share)",
        x=x,
        chosen=first,
        others=dict(others),
        promise="at most 0.01",
        bound=[0.01] * len(x),
    )
