// A quad over the whole screen, as a strip of four vertices.

out vec2 place;  // (0, 0) in the upper left corner of the picture, (1, 1) in the lower right

void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    place = vec2(corner.x, 1.0 - corner.y);
    gl_Position = vec4(2.0 * corner - 1.0, 0.0, 1.0);
}
