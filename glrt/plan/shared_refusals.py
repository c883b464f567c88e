"""Why a picture whose pixels share random numbers does not go with some options."""

_ALIKE = "half of the samples would err alike in all pixels"
_PROVEN = "it is proven for the methods naive, nee and mis alone"

NOT_SHARED: dict[str, str] = {  # by name of the option in `Way`
    "CROP": "pixels at its edge would have other neighbours",
    "AOV": _ALIKE,
    "TERMS": _ALIKE,
    "LAYERS": _ALIKE,
    "FRAGMENT": "a fragment shader writes to too few textures for it",
    "INDEPENDENT": "each is a sampler",
    "ADAPTIVE": "it needs equal counts of samples in all pixels: leave out --adaptive",
    "CLASSIC": _PROVEN,
    "PROBES": _PROVEN,
    "REUSE": _PROVEN,
    "HYBRID": _PROVEN,
    "MARCH": _PROVEN,
    "DENOISE": "a denoiser takes errors that neighbours share for detail",
    "AUTO": "it chooses by the error of plain pictures: name a method",
    "SHUTTER": "all pixels would see the same times",
    "CLUSTER": "it needs pixels beyond a band: leave out one of them",
}
