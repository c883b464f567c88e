"""The structs and constants that host and kernel share, read from the shader files."""

from glrt.gpu.glsl import expanded
from glrt.gpu.structs import read_constants, read_structs

_TEXT = expanded("structs/scene.glsl")
STRUCTS = read_structs(_TEXT)
CONSTANTS = read_constants(_TEXT)
