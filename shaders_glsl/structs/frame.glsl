// Data that changes from frame to frame: the camera, the background, counts, and the part of a dispatch.

struct Camera {
    vec3 right;     // unit
    float tan_x;    // half the width of the image plane at distance 1
    vec3 up;        // unit
    float tan_y;
    vec3 forward;   // unit
    float lens_radius;
    float tan_lens; // lens radius over focus distance
};

struct Frame {
    Camera camera;
    vec3 background_bottom;  // radiance from below, from the horizon and from above
    int bounces;             // scattering events on a path
    vec3 background_horizon;  // where HAS_HORIZON
    int is_empty;            // 1: the film holds nothing yet, whatever its textures hold
    vec3 background_top;
    uint seed;
    ivec2 size;              // of the full frame, pixels
    ivec2 origin;            // of the crop in it
    int first_sample;        // number of the first sample that this dispatch adds, from 0
    int sample_count;        // how many samples it adds
    int sphere_count;
    int plane_count;
    int quad_count;
    int disk_count;
    int box_count;
    int cylinder_count;
    int mesh_count;
    int light_count;
    int first_tile;         // first tile of this dispatch: see tiles.glsl
    int tile_stride;
    int node_count;
    int slot_count;
    vec3 tree_center;       // centre of the tree's grid, relative to the camera
    float tree_cell;        // edge of a cell, a power of two
    vec3 sun_direction;      // unit, towards the sun; where HAS_SUN
    float sun_versine;       // 1 - cos of half the angle that the sun fills
    vec3 sun_radiance;
    float splat_unit;        // radiance of one unit of the sums that particles add to pixels (particles.comp)
    vec3 camera_absorption;  // of the glass around the camera, per unit length
    uint camera_counts;      // counts of the glasses with a priority around it (integrators/glasses.glsl), or volumes
    vec3 bounds_center;     // centre of a ball around all shapes but planes, where particles leave the sun
    float bounds_radius;
    float background_turn;  // rotation of its image about +y, in turns from 0 to 1
    float sky_density;      // scale of the density of its samples, per solid angle: lights/sky_sampling.glsl
    float particles;        // number of particles that leave lamps, for each sample of a pixel; where HAS_PARTICLES
    float aimed;            // share of the particles that is aimed at smooth spheres
    float linked;           // share that is also linked to the camera through spheres, where LINKED is not 0
    int linked_groups;      // work groups of these particles
    float from_sun;         // share of the particles that leaves the sun
    float from_sky;         // share that leaves the sky, where SKY_SENDS
    vec3 probe_first;       // place of the first probe of the grid, relative to the camera; where HAS_PROBES
    float probe_edge;       // the shortest edge of a cell
    vec3 probe_cell;        // the edges of a cell
    int probe_count;
    ivec3 probe_counts;     // along x, y and z
    float coincident_reach; // largest coordinate of surfaces in one place, relative to the camera; where HAS_COINCIDENT
    int camera_medium;      // row of the medium around the camera, or NO_MEDIUM
    float phong_ambient;    // constants of integrators/phong.glsl, where OWN_PHONG; below 0: as the material has it
    float phong_diffuse;
    float phong_specular;
    int phong_exponent;
    float march_step;       // length of a step; 0: that of a voxel. Where MARCHES
};
