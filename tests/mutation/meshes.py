"""Bugs of triangle meshes: gaps, leaks, wrong sides, lost lamps."""

from tests.mutation.mutant import Edit, Mutant, edit

_HITS = "rendering/test_mesh_hits.py"
_TRUTHS = "truths/test_meshes.py"
_COLORS = "truths/test_vertex_colors.py"
_OWN = "scene/test_own_materials.py"

MESHES = [
    Mutant(
        "a ray through an edge meets neither triangle",
        edit(
            "shapes/mesh.glsl",
            "shares.x >= 0.0 && shares.y >= 0.0 && shares.z >= 0.0",
            "shares.x > 0.0 && shares.y > 0.0 && shares.z > 0.0",
        ),
        f"{_HITS}::test_no_ray_from_inside_gets_out_at_an_edge",
    ),
    Mutant(
        "a ray leaves its triangle from where it was hit, not clear of it",
        edit("shapes/mesh.glsl", "    place += shift * left.normal;\n", ""),
        f"{_HITS}::test_a_ray_leaves_its_triangle_and_its_neighbours",
    ),
    Mutant(
        "a ray always leaves on the outer side of its triangle",
        edit(
            "shapes/mesh.glsl",
            "< 0.0 ? -CLEARANCE * largest : CLEARANCE",
            "< 0.0 ? CLEARANCE * largest : CLEARANCE",
        ),
        f"{_HITS}::test_a_ray_leaves_its_triangle_and_its_neighbours",
    ),
    Mutant(
        "rays start a fixed distance off triangles",
        edit("shapes/mesh.glsl", "larger(away.z, left.reach));", "1.0);"),
        f"{_TRUTHS}::test_meshes_scaled_by_a_power_of_two_keep_their_bits",
    ),
    Mutant(
        "the second triangle of a leaf is not tested",
        edit("shapes/tree.glsl", "if (triangles.y != ray.origin_shape) hit", "if (false) hit"),
        f"{_HITS}::test_rays_find_what_arithmetic_in_float64_finds",
    ),
    Mutant(
        "a box that is cut loses its far half",
        (
            Edit("glrt/accel/split_boxes.py", "([lower, far_low])", "([lower, near_low])"),
            Edit("glrt/accel/split_boxes.py", "([upper, far_high])", "([upper, near_high])"),
        ),
        f"{_HITS}::test_rays_find_what_arithmetic_in_float64_finds",
    ),
    Mutant(
        "normals of meshes are stretched with them",
        (
            Edit(
                "glrt/scene/meshes.py",
                "self.triangles.shading_normals @ np.linalg.inv(self.linear)",
                "self.triangles.shading_normals @ self.linear.T",
            ),
        ),
        "scene/test_triangle_meshes.py::test_normals_stay_across_and_outside_of_what_is_stretched_or_mirrored",
    ),
    Mutant(
        "a triangle's light is that of its neighbour in the list",
        (Edit("glrt/rendering/pack_tree.py", "|= (light + 1) << 16", "|= (light + 2) << 16"),),
        f"{_TRUTHS}::test_each_triangle_that_emits_has_its_own_density",
    ),
    Mutant(
        "the density of a point on a triangle is that of a parallelogram",
        edit("lights/triangle.glsl", "0.5 * cross(edge_b, edge_c)", "cross(edge_b, edge_c)"),
        f"{_TRUTHS}::test_a_lamp_of_triangles_lights_as_one_of_a_quad",
    ),
    Mutant(
        "points on triangles are dense at one corner",
        edit("lights/triangle.glsl", "float root = sqrt(u.x);", "float root = u.x;"),
        f"{_TRUTHS}::test_a_lamp_of_triangles_lights_as_one_of_a_quad",
    ),
    Mutant(
        "the shading normal decides which side is outside",
        edit(
            "integrators/path.glsl",
            "precise vec3 facing = true_normal(surface);",
            "precise vec3 facing = surface.normal;",
        ),
        f"{_TRUTHS}::test_light_from_behind_a_triangle_does_not_light_it",
    ),
    Mutant(
        "colours of two corners change places",
        edit("shapes/mesh.glsl", "(tint_at(corners.y).color", "(tint_at(corners.z).color"),
        f"{_COLORS}::test_between_the_corners_colours_are_linear",
    ),
    Mutant(
        "hidden meshes push the colours of others",
        (
            Edit(
                "glrt/rendering/pack_mesh.py",
                "placed = scene.meshes",
                "placed = [it for it in scene.objects if isinstance(it, Mesh)]",
            ),
        ),
        f"{_COLORS}::test_each_mesh_has_its_own_colours",
    ),
    Mutant(
        "codes of sRGB at vertices are taken for light",
        (Edit("glrt/scene/mesh_formats.py", "return decode_srgb(found / ", "return (found / "),),
        "scene/test_mesh_colors.py::test_colours_are_read_as_linear_light",
    ),
    Mutant(
        "floats of PLY files are taken for sRGB",
        (Edit("glrt/scene/mesh_formats.py", 'if suffix == ".obj" else', "if True else"),),
        "scene/test_mesh_colors.py::test_colours_are_read_as_linear_light",
    ),
    Mutant(
        "each material of a mesh has normals of its own",
        (Edit("glrt/scene/triangle_meshes.py", "normals[used], colors\n", "None, colors\n"),),
        f"{_OWN}::test_normals_at_borders_are_those_of_the_whole",
    ),
    Mutant(
        "the materials of an OBJ file go to its parts in the wrong order",
        (Edit("glrt/scene/mesh_formats.py", "return found[::-1]", "return found"),),
        f"{_OWN}::test_an_object_becomes_a_mesh_for_each_material",
    ),
    Mutant(
        "a part of a mesh is all of it",
        (Edit("glrt/scene/meshes.py", "return mesh.parts[self.part]", "return mesh"),),
        f"{_OWN}::test_the_picture_is_that_of_two_meshes_to_the_bit",
    ),
    Mutant(
        "the alpha of Phong's exponent is taken for the roughness",
        (Edit("glrt/scene/mtl_files.py", "math.sqrt(alpha))", "alpha)"),),
        "scene/test_mtl_files.py::test_values_become_a_material",
    ),
    Mutant(
        "materials of a file replace those of the scene",
        (
            Edit(
                "glrt/scene/own_materials.py",
                'self.materials.setdefault(f"{file.file}:{name}", own[name])',
                'self.materials[f"{file.file}:{name}"] = own[name]',
            ),
        ),
        f"{_OWN}::test_python_may_leave_the_material_out",
    ),
]
