// Corners of the triangles of one object, on a part of the picture.

in vec3 corner;  // relative to the middle of the object
uniform mat4 to_part;

void main() {
    gl_Position = to_part * vec4(corner, 1.0);
}
