"""Bugs of meshes with trees of their own: rays that do not get in or out, normals, stale trees."""

from tests.mutation.mutant import Edit, Mutant, edit

_HITS = "rendering/test_instances.py"
_MOVES = "view/test_moved_meshes.py"

INSTANCES = [
    Mutant(
        "a ray that leaves an instance goes on in its frame",
        edit("shapes/tree.glsl", "walk.gets_out && now.instance > 0;", "false;"),
        f"{_HITS}::test_rays_find_the_nearest_of_instances_and_shapes",
    ),
    Mutant(
        "what is left beside an instance is forgotten",
        edit("shapes/tree.glsl", "(keeps || walk.goes_in)", "keeps"),
        f"{_HITS}::test_rays_find_the_nearest_of_instances_and_shapes",
    ),
    Mutant(
        "shadow rays forget what is left beside an instance",
        edit("shapes/tree.glsl", "(enters || walk.goes_in)", "enters"),
        f"{_HITS}::test_rays_find_the_nearest_of_instances_and_shapes",
    ),
    Mutant(
        "a ray leaves the triangle of an instance from where it was hit",
        edit("shapes/tree.glsl", "left.instance ? start + left.shift : start", "0 ? start : start"),
        f"{_HITS}::test_a_ray_leaves_the_triangle_of_an_instance",
    ),
    Mutant(
        "a ray is moved clear of an instance as if all its axes were alike",
        edit("shapes/mesh.glsl", "dot(abs(inward.to_y), size)", "dot(abs(inward.to_x), size)"),
        f"{_HITS}::test_a_ray_leaves_the_triangle_of_an_instance",
    ),
    Mutant(
        "normals of instances are stretched with them",
        edit(
            "shapes/instance.glsl",
            "normal.x * instance.to_x + normal.y * instance.to_y + normal.z * instance.to_z",
            "normal.x * instance.from_x + normal.y * instance.from_y + normal.z * instance.from_z",
        ),
        f"{_HITS}::test_stretched_instances_are_shaded_as_if_kept_apart",
    ),
    Mutant(
        "a mesh that is moved is met where it was",
        (Edit("glrt/rendering/device_scene.py", "kept.content is not slots", "False"),),
        f"{_MOVES}::test_a_large_mesh_that_is_moved_again_builds_and_uploads_no_tree",
    ),
    Mutant(
        "a recipe does not tell that meshes were moved",
        (
            Edit(
                "glrt/rendering/renderer.py",
                'apart="large" if self.plan.apart == "large" else "repeated"',
                'apart="repeated"',
            ),
        ),
        f"{_MOVES}::test_a_picture_with_moved_meshes_is_made_again_from_its_recipe",
    ),
]
