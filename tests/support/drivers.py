"""Mesa as other drivers, for processes that have this in their environment."""

# Features that OpenGL 4.1 lacks are removed: under a version alone compute shaders still compile.
OLD_DRIVER = {
    "MESA_GL_VERSION_OVERRIDE": "4.1",
    "MESA_GLSL_VERSION_OVERRIDE": "410",
    "MESA_EXTENSION_OVERRIDE": "-GL_ARB_compute_shader -GL_ARB_shader_storage_buffer_object "
    "-GL_ARB_shader_image_load_store",
}
# OpenGL over Vulkan, on a processor: another compiler, whose arithmetic rounds elsewhere.
ZINK = {"GALLIUM_DRIVER": "zink", "LIBGL_ALWAYS_SOFTWARE": "1"}
