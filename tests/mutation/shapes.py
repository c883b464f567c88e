"""Bugs of shapes: where rays hit them, and what a tree of spheres leaves out."""

from tests.mutation.mutant import Edit, Mutant, edit

SHAPES = [
    Mutant(
        "hits nearer than a fixed epsilon are ignored",
        edit(
            "shapes/find_hit.glsl",
            "t > 0.0 && t < hit.distance && i != ignored",
            "t > 1e-3 && t < hit.distance && i != ignored",
        ),
        "truths/test_invariance.py::test_scene_scaled_by_a_power_of_two_keeps_its_bits",
    ),
    Mutant(
        "the sphere's discriminant is b^2 - c",
        edit(
            "shapes/sphere.glsl",
            "r2 - dot(beside, beside)",
            "along * along - (dot(to_center, to_center) - r2)",
        ),
        "shaders/test_sphere.py::test_spheres_are_hit_where_float64_says_from_near_and_from_far",
    ),
    Mutant(
        "points stay where the distance leaves them, beside their sphere",
        edit(
            "shapes/sphere.glsl",
            "vec3 position = sphere.center + sphere.radius * normal;",
            "vec3 position = p;",
        ),
        "shaders/test_shape.py::test_a_point_that_was_hit_from_afar_lies_on_its_shape_to_the_last_digits",
    ),
    Mutant(
        "a ray that starts on an edge of a box gets out past the next face",
        edit("shapes/box.glsl", "larger(crossing.leaves, NO_WAY)", "crossing.leaves"),
        "shaders/test_box.py::test_a_ray_into_a_box_ends_on_another_face_seen_from_inside",
    ),
    Mutant(
        "a ray meets the box that it leaves outwards",
        edit("shapes/box.glsl", "if (shape == ray.origin_shape) return", "if (ray.inward) return"),
        "shaders/test_box.py::test_a_ray_that_leaves_a_box_outwards_never_meets_it_again",
    ),
    Mutant(
        "from inside a box, the face behind is met",
        edit("shapes/box.glsl", "inside ? crossing.last : crossing.first", "crossing.first"),
        "shaders/test_box.py::test_the_point_hit_lies_on_a_face_and_faces_the_ray",
    ),
    Mutant(
        "the inside of an open end of a cylinder is met",
        edit("shapes/cylinder.glsl", "abs(height) <= half_height ? t : 0.0", "t"),
        "shaders/test_cylinder.py::test_cylinders_are_hit_where_float64_says",
    ),
    Mutant(
        "a ray that starts on the rim of a cylinder gets out past it",
        edit("shapes/cylinder.glsl", "return larger(leaves, NO_WAY)", "return leaves"),
        "shaders/test_cylinder.py::test_a_ray_into_a_closed_cylinder_ends_on_it_seen_from_inside",
    ),
    Mutant(
        "from a cap of a cylinder the wall is met as if from the wall",
        edit("shapes/cylinder.glsl", "|| to_wall <= to_end", "|| to_wall >= 0.0"),
        "shaders/test_cylinder.py::test_a_ray_into_a_closed_cylinder_ends_on_it_seen_from_inside",
    ),
    Mutant(
        "boxes of the tree leave no room for rounding",
        (
            Edit(
                "shaders_glsl/shapes/sphere_tree.glsl",
                "const float SPHERE_SLACK = 3.814697265625e-6;",
                "const float SPHERE_SLACK = 0.0;",
            ),
            Edit("glrt/accel/sphere_nodes.py", "SLACK = 2.0**-18", "SLACK = 0.0"),
        ),
        "accel/test_spheres_by_tree.py::test_a_ray_finds_by_the_tree_what_it_finds_without",
    ),
    Mutant(
        "of equal spheres the tree takes the one that it meets first",
        edit("shapes/sphere_tree.glsl", "t == hit.distance && shape < hit.shape", "false"),
        "accel/test_spheres_by_tree.py::test_a_ray_finds_by_the_tree_what_it_finds_without",
    ),
    Mutant(
        "a ray that misses a box of the tree leaves out the node behind it, too",
        edit("shapes/sphere_tree.glsl", "? 1 : 1 + below;", "? 1 : 2 + below;"),
        "accel/test_spheres_by_tree.py::test_a_ray_finds_by_the_tree_what_it_finds_without",
    ),
    Mutant(
        "boxes of the tree over shapes are met where they lie, without room for rounding",
        edit("shapes/tree_node.glsl", "SLACK * larger(", "0.0 * larger("),
        "accel/test_shapes_by_tree.py::test_a_ray_finds_by_the_tree_what_it_finds_without",
    ),
    Mutant(
        "of equal shapes the tree takes the one that it meets first",
        edit("shapes/tree.glsl", "t == hit.distance && shape < hit.shape", "false"),
        "accel/test_shapes_by_tree.py::test_a_ray_finds_by_the_tree_what_it_finds_without",
    ),
    Mutant(
        "along an axis a ray with a zero below 0 enters boxes at their far sides",
        edit("shapes/tree_node.glsl", "lessThan(inverse,", "lessThan(direction,"),
        "accel/test_shapes_by_tree.py::test_a_ray_finds_by_the_tree_what_it_finds_without",
    ),
    Mutant(
        "the stack of the tree forgets its second entry",
        edit("shapes/tree_stack.glsl", "s.e1 = pushes ? s.e0 : s.e1;", "s.e1 = s.e1;"),
        "accel/test_shapes_by_tree.py::test_a_ray_finds_by_the_tree_what_it_finds_without",
    ),
    Mutant(
        "children that a node does not have are visited",
        edit("shapes/tree_node.glsl", " && number <= children.last", ""),
        "accel/test_shapes_by_tree.py::test_children_that_a_node_does_not_have_are_not_visited",
    ),
    Mutant(
        "boxes of children end a cell too soon",
        (
            Edit(
                "glrt/accel/wide_tree.py",
                "end = np.ceil((high - corner",
                "end = np.floor((high - corner",
            ),
        ),
        "accel/test_wide_tree.py::test_the_box_of_a_child_holds_all_below_it_and_little_more",
    ),
    Mutant(
        "shadow rays leave out what is left of a node when they go below",
        edit("shapes/tree.glsl", "bool pushes = (enters || walk.goes_in)", "bool pushes = false"),
        "accel/test_shapes_by_tree.py::test_a_ray_finds_by_the_tree_what_it_finds_without",
    ),
]
