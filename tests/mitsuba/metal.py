"""glrt's rough metal as a plug-in of Mitsuba.

`roughconductor` takes the shadowing of both directions as independent (G = G1 G1'); glrt correlates
them by height (Heitz 2014, eq. 99). Distribution, sampling and G1 are Mitsuba's own.
"""

from functools import cache
from typing import Any

NAME = "glrt_metal"


@cache
def register(variant: str) -> None:
    """Make the plug-in known to Mitsuba, whose current variant this must be."""
    import drjit as dr  # type: ignore[import-not-found, unused-ignore]
    import mitsuba  # type: ignore[import-not-found, unused-ignore]

    mi: Any = mitsuba

    class Metal(mi.BSDF):  # type: ignore[misc]
        """Parameters: `alpha` of GGX, the colour `reflectance`, n0 to n2 and k0 to k2 of it."""

        def __init__(self, properties: Any) -> None:
            mi.BSDF.__init__(self, properties)
            self.alpha = properties["alpha"]
            self.reflectance = mi.Color3f(properties["reflectance"])
            self.indices = [
                mi.Complex2f(properties[f"n{c}"], properties[f"k{c}"])
                for c in range(3)
                if f"n{c}" in properties
            ]
            flags = mi.BSDFFlags.GlossyReflection | mi.BSDFFlags.FrontSide
            self.m_components = [flags]
            self.m_flags = flags

        def normals(self) -> Any:
            return mi.MicrofacetDistribution(mi.MicrofacetType.GGX, self.alpha, True)

        def sample(self, context: Any, si: Any, _choice: Any, u: Any, active: Any) -> Any:
            normals = self.normals()
            half, density = normals.sample(si.wi, u)
            wo = mi.reflect(si.wi, half)
            active = active & (si.wi.z > 0) & (wo.z > 0) & (density > 0)
            sample = dr.zeros(mi.BSDFSample3f)
            sample.wo = wo
            sample.eta = 1.0
            sample.sampled_component = 0
            sample.sampled_type = +mi.BSDFFlags.GlossyReflection
            sample.pdf = dr.select(active, density / (4 * dr.dot(wo, half)), 0)
            shadow = self.shadow(normals, si.wi, wo, half) / normals.smith_g1(si.wi, half)
            weight = self.fresnel(dr.dot(si.wi, half)) * shadow
            return sample, dr.select(active, weight, mi.Color3f(0))

        def eval(self, context: Any, si: Any, wo: Any, active: Any) -> Any:
            return self.eval_pdf(context, si, wo, active)[0]

        def pdf(self, context: Any, si: Any, wo: Any, active: Any) -> Any:
            return self.eval_pdf(context, si, wo, active)[1]

        def eval_pdf(self, context: Any, si: Any, wo: Any, active: Any) -> Any:
            normals = self.normals()
            half = dr.normalize(si.wi + wo)
            active = active & (si.wi.z > 0) & (wo.z > 0)
            lobe = normals.eval(half) / (4 * si.wi.z)
            value = self.fresnel(dr.dot(si.wi, half)) * lobe
            value *= self.shadow(normals, si.wi, wo, half)
            density = lobe * normals.smith_g1(si.wi, half)
            return dr.select(active, value, mi.Color3f(0)), dr.select(active, density, 0)

        def fresnel(self, cosine: Any) -> Any:
            if not self.indices:
                return self.reflectance
            reflected = [mi.fresnel_conductor(cosine, index) for index in self.indices]
            return self.reflectance * mi.Color3f(*reflected)

        def shadow(self, normals: Any, wi: Any, wo: Any, half: Any) -> Any:
            """G2 = 1 / (1 + L + L'), from G1 = 1 / (1 + L)."""
            a, b = normals.smith_g1(wi, half), normals.smith_g1(wo, half)
            return a * b / (a + b - a * b)

        def to_string(self) -> str:
            return f"Metal[alpha = {self.alpha}]"

    mi.register_bsdf(NAME, Metal)
