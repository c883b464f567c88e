// Part of a picture on a screen, each of its pixels a square of one colour.

uniform sampler2D picture;  // row 0 is the lowest, as in OpenGL
uniform vec2 corner;        // upper left of the part, in pixels of the picture
uniform vec2 extent;        // of the part

in vec2 place;
out vec4 color;

void main() {
    ivec2 size = textureSize(picture, 0);
    vec2 texel = floor(corner + place * extent);
    ivec2 inside = clamp(ivec2(texel), ivec2(0), size - 1);
    color = texelFetch(picture, ivec2(inside.x, size.y - 1 - inside.y), 0);
}
