// The value of an image at texture coordinates. It is bilinear between the middles of four texels, computed here so
// that drivers agree to the bit.

// Maps a place into 0..1, by clamping, repeating or mirroring the image.
float within(float place, int wrap) {
    if (wrap == CLAMP) return clamp(place, 0.0, 1.0);
    float period = wrap == MIRROR ? 2.0 : 1.0;
    float rest = place - period * floor(place / period);
    float folded = rest > 1.0 ? 2.0 - rest : rest;
    return clamp(folded, 0.0, 1.0);
}

// The number of a texel that may lie next to the image: across the edge where the image repeats.
int wrapped(int number, int size, int wrap) {
    if (wrap != REPEAT) return clamp(number, 0, size - 1);
    if (number < 0) return number + size;
    return number < size ? number : number - size;
}

vec4 texel_of(Map map, int column, int row) {
    vec4 texel = texel_at(map.first + row * map.width + column);
    return texel;
}

vec4 map_value(int number, Coordinates at) {
    Map map = map_at(number);
    vec3 uv = vec3(map.set == 0 ? at.first : at.second, 1.0);
    float across = within(dot(map.u, uv), map.wrap_u) * float(map.width);
    float down = within(dot(map.v, uv), map.wrap_v) * float(map.height);
    if (map.is_sharp != 0) {
        int column = min(int(across), map.width - 1);
        int row = min(int(down), map.height - 1);
        return texel_of(map, column, row);
    }
    vec2 place = vec2(across, down) - 0.5;
    vec2 corner = floor(place);
    vec2 share = place - corner;
    int left = wrapped(int(corner.x), map.width, map.wrap_u);
    int right = wrapped(int(corner.x) + 1, map.width, map.wrap_u);
    int above = wrapped(int(corner.y), map.height, map.wrap_v);
    int below = wrapped(int(corner.y) + 1, map.height, map.wrap_v);
    vec4 left_above = texel_of(map, left, above);
    vec4 left_below = texel_of(map, left, below);
    vec4 upper = left_above + share.x * (texel_of(map, right, above) - left_above);
    vec4 lower = left_below + share.x * (texel_of(map, right, below) - left_below);
    vec4 value = upper + share.y * (lower - upper);
    return value;
}

float channel_of(vec4 value, int channel) {
    if (channel == 3) return value.w;
    if (channel == 2) return value.z;
    return channel == 1 ? value.y : value.x;
}

float number_at(int number, Coordinates at) {
    return channel_of(map_value(number, at), map_at(number).channel);
}

vec3 color_at(int number, Coordinates at) {
    vec4 value = map_value(number, at);
    int channel = map_at(number).channel;
    return channel == ALL_CHANNELS ? value.xyz : vec3(channel_of(value, channel));
}
