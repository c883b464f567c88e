// Places what is drawn on the screen, so large that each pixel whose square it touches gets a fragment.

#include "raster.glsl"

uniform int raster_part;
uniform ivec2 raster_size;         // of the crop, pixels
uniform isampler2D raster_order;   // triangles by their numbers: twice the slot and which of it, and the instance
flat out int drawn;
flat out int instance;

const float ROUNDED = 9.5367431640625e-7;  // 2^-20: rounding of a coordinate and of a hit, relative to the largest
const float CLOSE = 9.765625e-4;          // 2^-10: depth, relative to the largest coordinate, below which bounds are rough
const float MARGIN = 0.75;               // pixels: half of one, and the rounding of the rasteriser
const float BEYOND = 3.0;                // places on the screen, -1 to 1, are drawn up to here

// Where points lie: along the axes of the camera, on the screen, and how far off rounding may put them there.
struct Extent {
    vec3 low;
    vec3 high;
    vec2 least;
    vec2 most;
    float size;  // the largest coordinate
    float off;   // per unit of depth
};

Extent no_extent() {
    return Extent(vec3(FAR), vec3(-FAR), vec2(FAR), vec2(-FAR), 0.0, 0.0);
}

vec3 seen(vec3 point) {
    vec3 view = vec3(dot(frame.camera.right, point), dot(frame.camera.up, point), dot(frame.camera.forward, point));
    return view;
}

vec2 on_screen(vec3 view) {
    vec2 place = vec2(view.x / frame.camera.tan_x, view.y / frame.camera.tan_y) / view.z;
    return place;
}

void add_point(inout Extent it, vec3 point) {
    vec3 view = seen(point);
    vec3 away = abs(point);
    float size = larger(away.x, larger(away.y, away.z));
    vec2 place = on_screen(view);
    it.low = min(it.low, view);
    it.high = max(it.high, view);
    it.least = min(it.least, place);
    it.most = max(it.most, place);
    it.size = larger(it.size, size);
    it.off = larger(it.off, size / view.z);
}

// From the lower left to the upper right corner on the screen; with the first above the second nothing is seen.
struct Screen {
    vec2 least;
    vec2 most;
};

vec2 slack_of(float off) {
    if (WITHOUT_MARGIN) return vec2(0.0);
    vec2 slack = 2.0 * MARGIN / vec2(frame.size) + ROUNDED * off / vec2(frame.camera.tan_x, frame.camera.tan_y);
    return slack;
}

// Least and greatest of x / z for x between two numbers, and z between 0 and `deep`.
vec2 range_of_ratio(float low, float high, float deep) {
    float least = low > 0.0 ? low / deep : -BEYOND;
    float most = high < 0.0 ? high / deep : BEYOND;
    return vec2(least, most);
}

bool is_before(Extent it) { return it.low.z > CLOSE * it.size; }

// Around the convex hull of points. Where it reaches behind the camera, only bounds of its coordinates are used.
Screen screen_of(Extent it) {
    float slack = ROUNDED * it.size;
    if (it.high.z + slack <= 0.0) return Screen(vec2(1.0), vec2(-1.0));
    if (is_before(it)) return Screen(it.least - slack_of(it.off), it.most + slack_of(it.off));
    float deep = it.high.z + slack;
    vec2 x = range_of_ratio(it.low.x - slack, it.high.x + slack, deep * frame.camera.tan_x);
    vec2 y = range_of_ratio(it.low.y - slack, it.high.y + slack, deep * frame.camera.tan_y);
    return Screen(vec2(x.x, y.x) - slack_of(0.0), vec2(x.y, y.y) + slack_of(0.0));
}

Screen screen_around(vec3 middle, vec3 a, vec3 b, vec3 c) {
    Extent it = no_extent();
    for (int i = 0; i < 8; i += 1) {
        vec3 signs = vec3(ivec3(i & 1, i >> 1 & 1, i >> 2) * 2 - 1);
        vec3 point = middle + signs.x * a + signs.y * b + signs.z * c;
        add_point(it, point);
    }
    return screen_of(it);
}

Screen screen_of_shape(int shape) {
    if (HAS_SPHERE && up_to_sphere(shape)) {
        Sphere sphere = sphere_at(shape);
        Camera camera = frame.camera;
        return screen_around(
            sphere.center, sphere.radius * camera.right, sphere.radius * camera.up, sphere.radius * camera.forward);
    }
    if (HAS_QUAD && is_quad(shape)) {
        Quad quad = quad_at(shape - first_quad());
        vec3 a = 0.5 * quad.edge_u;
        vec3 b = 0.5 * quad.edge_v;
        return screen_around(quad.corner + a + b, a, b, vec3(0.0));
    }
    if (HAS_DISK && is_disk(shape)) {
        Disk disk = disk_at(shape - first_disk());
        mat3 axes = frame_around(disk.normal);
        return screen_around(disk.center, disk.radius * axes[0], disk.radius * axes[1], vec3(0.0));
    }
    if (HAS_BOX && is_box(shape)) {
        Box box = box_at(shape - first_box());
        return screen_around(box.center, box.half_x * box.axis_x, box.half_y * box.axis_y, box.half_z * box.axis_z);
    }
    if (HAS_CYLINDER && is_cylinder(shape)) {
        Cylinder cylinder = cylinder_at(shape - first_cylinder());
        mat3 axes = frame_around(cylinder.axis);
        vec3 along = cylinder.half_height * cylinder.axis;
        return screen_around(cylinder.center, cylinder.radius * axes[0], cylinder.radius * axes[1], along);
    }
    if (HAS_MESH && is_mesh(shape)) return Screen(vec2(1.0), vec2(-1.0));
    return Screen(vec2(-BEYOND), vec2(BEYOND));  // a plane may be seen anywhere
}

// The corners of a triangle, relative to the camera.
vec3[3] corners_of(int number, int of_instance) {
    Slot slot = slot_at(number >> 1);
    vec4 a = uintBitsToFloat(slot.a);
    vec4 b = uintBitsToFloat(slot.b);
    vec4 c = uintBitsToFloat(slot.c);
    vec3 q = vec3(a.w, b.xy);
    vec3 r = vec3(b.zw, c.x);
    vec3 s = c.yzw;
    bool is_first = (number & 1) == 0;
    vec3[3] corners = vec3[3](a.xyz, is_first ? q : r, is_first ? r : s);
    for (int i = 0; i < 3; i += 1) {
        if (HAS_INSTANCE && of_instance > 0) corners[i] = place_of(instance_at(of_instance - 1), corners[i]);
        corners[i] += frame.tree_center;
    }
    return corners;
}

float crossed(vec2 a, vec2 b) {
    float product = a.x * b.y - a.y * b.x;
    return product;
}

// The triangle with its edges moved outwards as far as the corners of a pixel reach ("Conservative Rasterization",
// Hasselgren, Akenine-Moeller, Ohlsson, GPU Gems 2, 2005). `area`: of the result, infinite or NaN where it has no
// corners.
vec2[3] grown(vec2[3] corners, vec2 slack, out float area) {
    vec2 u = corners[1] - corners[0];
    vec2 v = corners[2] - corners[0];
    float turn = crossed(u, v) < 0.0 ? -1.0 : 1.0;
    vec2[3] normals;
    float[3] limits;
    for (int i = 0; i < 3; i += 1) {
        vec2 edge = corners[(i + 1) % 3] - corners[i];
        normals[i] = turn * vec2(edge.y, -edge.x);
        limits[i] = dot(normals[i], corners[i]) + dot(abs(normals[i]), slack);
    }
    vec2[3] result;
    for (int i = 0; i < 3; i += 1) {
        vec2 before = normals[(i + 2) % 3];
        vec2 after = normals[i];
        vec2 place = limits[(i + 2) % 3] * vec2(after.y, -after.x) - limits[i] * vec2(before.y, -before.x);
        result[i] = place / crossed(before, after);
    }
    area = 0.5 * abs(crossed(result[1] - result[0], result[2] - result[0]));
    return result;
}

// A vertex of one of two triangles that fill a rectangle.
vec2 corner_of(Screen screen, int vertex) {
    int corner = vertex < 3 ? vertex : 6 - vertex;
    vec2 share = vec2(ivec2(corner & 1, corner >> 1));
    vec2 least = clamp(screen.least, -BEYOND, BEYOND);
    vec2 most = clamp(screen.most, -BEYOND, BEYOND);
    bool is_seen = least.x < most.x && least.y < most.y;
    return is_seen ? least + share * (most - least) : vec2(-BEYOND);
}

// A vertex of a triangle: of the grown one, where that is smaller than the rectangle around it.
vec2 corner_of_face(ivec2 face, int vertex) {
    vec3[3] corners = corners_of(face.x, face.y);
    Extent it = no_extent();
    for (int i = 0; i < 3; i += 1) add_point(it, corners[i]);
    Screen screen = screen_of(it);
    if (!is_before(it)) return corner_of(screen, vertex);
    vec2[3] places;
    for (int i = 0; i < 3; i += 1) places[i] = on_screen(seen(corners[i]));
    float area = 0.0;
    vec2[3] around = grown(places, slack_of(it.off), area);
    vec2 sides = screen.most - screen.least;
    vec2 farthest = max(max(abs(around[0]), abs(around[1])), abs(around[2]));
    bool is_small = area < sides.x * sides.y && larger(farthest.x, farthest.y) < 2.0 * BEYOND;
    if (!is_small) return corner_of(screen, vertex);
    return vertex < 3 ? around[vertex] : around[0];
}

void main() {
    int number = gl_VertexID / 6;
    int vertex = gl_VertexID % 6;
    ivec2 item = ivec2(number, 0);
    vec2 place = vec2(0.0);
    if (HAS_MESH && raster_part == FACES) {
        int width = textureSize(raster_order, 0).x;
        item = texelFetch(raster_order, ivec2(number % width, number / width), 0).xy;
        place = corner_of_face(item, vertex);
    } else if (raster_part == PROXIES) {
        place = corner_of(screen_of_shape(number), vertex);
    } else {
        place = corner_of(Screen(vec2(-BEYOND), vec2(BEYOND)), vertex);
    }
    drawn = item.x;
    instance = item.y;
    vec2 pixel = vec2(place.x + 1.0, 1.0 - place.y) * 0.5 * vec2(frame.size) - vec2(frame.origin);
    gl_Position = vec4(2.0 * pixel / vec2(raster_size) - 1.0, 0.0, 1.0);
}
