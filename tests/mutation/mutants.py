"""Classic bugs of path tracers, each as a change of shader text and the fast test that finds it.

The tests themselves are on trial: `python -m tests.mutation` plants one bug after the other in a
copy of the tree and runs its test, which must fail.
"""

from tests.mutation.aovs import AOVS
from tests.mutation.ataa import ATAA
from tests.mutation.coincident import COINCIDENT
from tests.mutation.comparing import COMPARING
from tests.mutation.denoising import DENOISING
from tests.mutation.editor import EDITOR
from tests.mutation.film import FILM
from tests.mutation.glass import GLASS
from tests.mutation.glossy_particles import GLOSSY_PARTICLES
from tests.mutation.instances import INSTANCES
from tests.mutation.judging import JUDGING
from tests.mutation.lights import LIGHTS
from tests.mutation.live_probes import LIVE_PROBES
from tests.mutation.merging import MERGING
from tests.mutation.meshes import MESHES
from tests.mutation.metals import METALS
from tests.mutation.particle_normals import PARTICLE_NORMALS
from tests.mutation.particle_sky import PARTICLE_SKY
from tests.mutation.particles import PARTICLES
from tests.mutation.paths import PATHS
from tests.mutation.principled import PRINCIPLED
from tests.mutation.probes import PROBES
from tests.mutation.resampling import RESAMPLING
from tests.mutation.sampling import SAMPLING
from tests.mutation.shapes import SHAPES
from tests.mutation.sky import SKY
from tests.mutation.sphere_links import SPHERE_LINKS
from tests.mutation.taa import TAA
from tests.mutation.temporal import TEMPORAL
from tests.mutation.textures import TEXTURES
from tests.mutation.transport import TRANSPORT
from tests.mutation.wrls import WRLS

MUTANTS = [
    *TRANSPORT,
    *PRINCIPLED,
    *PARTICLES,
    *GLOSSY_PARTICLES,
    *PARTICLE_NORMALS,
    *PARTICLE_SKY,
    *SPHERE_LINKS,
    *PROBES,
    *LIVE_PROBES,
    *RESAMPLING,
    *SHAPES,
    *MESHES,
    *INSTANCES,
    *METALS,
    *TEXTURES,
    *GLASS,
    *LIGHTS,
    *COINCIDENT,
    *SKY,
    *SAMPLING,
    *FILM,
    *AOVS,
    *MERGING,
    *COMPARING,
    *PATHS,
    *EDITOR,
    *DENOISING,
    *JUDGING,
    *TEMPORAL,
    *TAA,
    *ATAA,
    *WRLS,
]
