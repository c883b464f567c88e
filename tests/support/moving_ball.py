"""A scene file of a ball that moves."""

MOVING_BALL = """
background = { color = [0.5, 0.6, 0.9] }
camera = { position = [0, 0, 5], look_at = [0, 0, 0] }
materials.red = { type = "lambertian", color = [0.8, 0.1, 0.1] }
objects = [{ shape = "sphere", name = "ball", center = [0, 0, 0], radius = 1, material = "red" }]
[animation]
fps = 3
tracks = [{ target = "objects.ball.center", times = [0, 1], values = [[-1, 0, 0], [1, 0, 0]] }]
"""
