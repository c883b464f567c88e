"""Why a picture with some options cannot be divided into bands for the workers of a cluster."""

_WHY = {  # by name of the option in `Way`
    "RESUME": "bands begin without samples",
    "PART": "both divide the picture",
    "MERGED": "a merged picture adds its samples in the order of its parts",
    "LAYERS": "bands lack the layers that the picture was summed from",
    "ADAPTIVE": "counts follow from pixels beyond a band",
    "PROBES": "each worker would fill all probes again",
    "REUSE": "each worker would fill all probes again",
    "PARTICLES": "each worker would follow all particles again",
    "DENOISE": "it needs pixels beyond a band",
    "AUTO": "its measurement needs --error",
    "TIME": "bands would end at different samples",
    "ERROR": "the error is that of the whole picture",
}
NOT_IN_BANDS: dict[str, str] = {name: f"{why}: leave out one of them" for name, why in _WHY.items()}
