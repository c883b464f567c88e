"""Planted bugs of textures, holes and glTF files."""

from tests.mutation.mutant import Edit, Mutant, edit

_SHADERS = "shaders/test_textures.py"
_TRUTHS = "truths/test_textures.py"
_MESHES = "scene/test_gltf_meshes.py"
_SCENES = "scene/test_gltf_scenes.py"
_KEYS = "scene/test_textures.py"

TEXTURES = [
    Mutant(
        "images stand on their heads",
        edit(
            "textures/map.glsl",
            "within(dot(map.v, uv), map.wrap_v)",
            "(1.0 - within(dot(map.v, uv), map.wrap_v))",
        ),
        f"{_SHADERS}::test_the_first_row_of_an_image_is_on_top",
    ),
    Mutant(
        "images are half a pixel off",
        edit("textures/map.glsl", "vec2(across, down) - 0.5", "vec2(across, down)"),
        f"{_SHADERS}::test_an_image_is_read_between_its_pixels_and_beyond_its_edges",
    ),
    Mutant(
        "images end at their edges where they repeat",
        edit("textures/map.glsl", "if (wrap != REPEAT) return", "if (wrap >= REPEAT) return"),
        f"{_SHADERS}::test_an_image_is_read_between_its_pixels_and_beyond_its_edges",
    ),
    Mutant(
        "mirrored images repeat",
        edit("textures/map.glsl", "wrap == MIRROR ? 2.0 : 1.0", "1.0"),
        f"{_SHADERS}::test_an_image_is_read_between_its_pixels_and_beyond_its_edges",
    ),
    Mutant(
        "the transform of a texture turns the other way",
        (Edit("glrt/scene/textures.py", "[[cos, sin], [-sin, cos]]", "[[cos, -sin], [sin, cos]]"),),
        f"{_SHADERS}::test_a_transform_is_that_of_gltf",
    ),
    Mutant(
        "spheres are seen from the other side",
        edit(
            "textures/coordinates.glsl",
            "vec2(turns_of(surface.normal),",
            "vec2(1.0 - turns_of(surface.normal),",
        ),
        f"{_SHADERS}::test_a_sphere_has_them_by_longitude_and_latitude",
    ),
    Mutant(
        "the green of normal maps leads downwards",
        edit(
            "textures/mapped.glsl",
            "if (dot(up, tangents.up) < 0.0)",
            "if (dot(up, tangents.up) > 0.0)",
        ),
        f"{_SHADERS}::test_a_normal_is_bent_along_u_and_against_v",
    ),
    Mutant(
        "mirrored coordinates turn tangents around",
        edit(
            "textures/mapped.glsl",
            "turn < 0.0 ? -1.0 : turn > 0.0 ? 1.0 : 0.0",
            "turn != 0.0 ? 1.0 : 0.0",
        ),
        f"{_SHADERS}::test_a_triangle_bends_them_by_its_coordinates",
    ),
    Mutant(
        "green is taken for blue",
        edit(
            "textures/map.glsl",
            "if (channel == 2) return value.z;",
            "if (channel == 2) return value.y;",
        ),
        f"{_SHADERS}::test_a_channel_alone",
    ),
    Mutant(
        "numbers of images are decoded as colors",
        (Edit("glrt/scene/file_contents.py", "color=named.is_color", "color=True"),),
        f"{_KEYS}::test_colors_are_decoded_and_numbers_are_not",
    ),
    Mutant(
        "colors of images are not decoded",
        (Edit("glrt/scene/file_contents.py", "color=named.is_color", "color=False"),),
        f"{_KEYS}::test_colors_are_decoded_and_numbers_are_not",
    ),
    Mutant(
        "a factor that is a default is lost in files",
        (
            Edit(
                "glrt/scene/surfaces.py",
                "if value not in (1.0, WHITE)}",
                "if name is value}",
            ),
        ),
        f"{_KEYS}::test_a_scene_is_written_back_as_it_was",
    ),
    Mutant(
        "rays to lamps meet holes",
        edit(
            "textures/holes.glsl",
            "HAS_HOLE) return find_hit(ray, limit",
            "HAS_HOLE || true) return find_hit(ray, limit",
        ),
        f"{_TRUTHS}::test_rays_to_lights_pass_the_layers_too",
    ),
    Mutant(
        "all layers have the same holes",
        edit("sampling/hole_numbers.glsl", "pcg_hash(hole_key + passed)", "pcg_hash(hole_key)"),
        f"{_TRUTHS}::test_layers_let_light_through_one_by_one",
    ),
    Mutant(
        "rays to lamps pass the holes of the segment before",
        edit(
            "integrators/path.glsl",
            "leave_vertex(rng.seed, path.depth + 1);",
            "leave_vertex(rng.seed, path.depth);",
        ),
        f"{_TRUTHS}::test_rays_to_lights_pass_what_the_path_has_passed",
    ),
    Mutant(
        "lamps behind holes are weighed from the hole",
        edit(
            "integrators/path.glsl",
            "emission_weight(path.start, met,",
            "emission_weight(path.ray, hit,",
        ),
        f"{_TRUTHS}::test_a_lamp_behind_a_hole_is_weighed_from_where_the_path_scattered",
    ),
    Mutant(
        "an image is wrapped along v as along u",
        edit(
            "textures/map.glsl",
            "within(dot(map.v, uv), map.wrap_v)",
            "within(dot(map.v, uv), map.wrap_u)",
        ),
        f"{_SHADERS}::test_an_image_is_read_between_its_pixels_and_beyond_its_edges",
    ),
    Mutant(
        "an image that is turned leaves its normals as they are",
        edit("textures/mapped.glsl", "= turned_back(map, texel.xy)", "= texel.xy"),
        f"{_SHADERS}::test_an_image_that_is_turned_turns_its_normals",
    ),
    Mutant(
        "an image that is mirrored leaves its normals as they are",
        edit("textures/mapped.glsl", "turn < 0.0 ? -offset.y", "turn < 0.0 ? offset.y"),
        f"{_SHADERS}::test_an_image_that_is_turned_turns_its_normals",
    ),
    Mutant(
        "tangents of shared meshes stay in their frame",
        edit("textures/mapped.glsl", "if (instance == 0) return along;", "return along;"),
        f"{_SHADERS}::test_tangents_of_corners_go_before_those_of_triangles",
    ),
    Mutant(
        "triangles of both orientations share a tangent",
        (Edit("glrt/scene/vertex_means.py", "total[is_mixed] = 0", "total[is_mixed] *= 1"),),
        "scene/test_vertex_means.py::test_mirrored_coordinates_share_nothing",
    ),
    Mutant(
        "glass by an image is as much glass as its factor says",
        edit("bsdfs/principled.glsl", "share *= clamp(material.crossed, 0.0, 1.0)", "share *= 1.0"),
        f"{_TRUTHS}::test_an_even_texture_gives_the_bits_of_its_value",
    ),
    Mutant(
        "metal is as rare beside glass by an image as with its factor",
        edit("bsdfs/principled.glsl", "metallic = whole / (1.0 - share)", "metallic *= 1.0"),
        f"{_TRUTHS}::test_an_even_texture_gives_the_bits_of_its_value",
    ),
    Mutant(
        "morph targets have the weights of the mesh where a node has its own",
        (
            Edit(
                "glrt/scene/gltf/attributes.py",
                'node.get("weights", mesh.get("weights", []))',
                'mesh.get("weights", [])',
            ),
        ),
        "scene/test_gltf_shapes.py::test_morph_targets_have_the_weights_of_the_file",
    ),
    Mutant(
        "strips of triangles face both ways",
        (
            Edit(
                "glrt/scene/gltf/primitives.py",
                "strip[1::2] = strip[1::2, [1, 0, 2]]",
                "strip = strip + 0",
            ),
        ),
        f"{_MESHES}::test_every_order_of_triangles",
    ),
    Mutant(
        "matrices of nodes are read by rows",
        (Edit("glrt/scene/gltf/nodes.py", ".reshape(4, 4).T", ".reshape(4, 4)"),),
        f"{_MESHES}::test_nodes_move_turn_scale_and_mirror",
    ),
    Mutant(
        "mirrored nodes show the backs of their triangles",
        (Edit("glrt/scene/gltf/primitives.py", "faces = faces[:, ::-1]", "faces = faces + 0"),),
        f"{_MESHES}::test_nodes_move_turn_scale_and_mirror",
    ),
    Mutant(
        "roughness is read from the channel of metal",
        (Edit("glrt/scene/gltf/looks.py", '("roughness", "g")', '("roughness", "b")'),),
        f"{_SCENES}::test_textures_have_their_channels_and_factors",
    ),
    Mutant(
        "candela are taken for watts",
        (Edit("glrt/scene/gltf/stage.py", "LUMENS = 683.0", "LUMENS = 1.0"),),
        f"{_SCENES}::test_a_point_light_has_its_intensity",
    ),
]
