// What light sampling chooses among.

const int NO_LIGHT = -1;
const int SEVERAL = -2;  // lamps, so no shape
const int SUN_LIGHT = -3;  // in place of the number of a lamp
const int SKY_LIGHT = -4;

const int PARTS = 8;  // of a cluster, among many lamps

struct Light {
    int shape;
    float share;  // of the flux of its part
    float keep;   // alias method: this light with probability `keep`, else its alias
    int alias;    // its part, an index into the clusters, << 16 | its alias
};

// Lamps close together. Of few lamps each is a cluster; the clusters of many are followed by PARTS
// of each, those of the first one first. A part holds the lamps from `first` on, or none.
struct Cluster {
    vec3 center;        // mean place of their flux
    float reach2;       // mean squared distance of their points from the center
    float probability;  // their share of all flux
    int first;
    int count;
    int shape;          // of the lamp if it is one, else SEVERAL
};

// What particles are aimed at, beside spheres of smooth glass or metal: a ball around a shape of these.
struct Target {
    vec3 center;
    float radius;
};

// How the particles of a flat lamp are spread over its sides, if they are not aimed.
struct Sides {
    float front;  // share of those that leave on the side of its normal
    float back;
    int spare_a;  // fill the row
    int spare_b;
};

// The directions into which the lamps of a cluster or a part emit: within a cone, at each of their points.
struct Aim {
    vec3 axis;    // unit; v is 1 - cos of the angle to it
    float outer;  // v from which on nothing is emitted
    float slope;  // 1 over the length of v over which the emission falls
    float reach;  // largest distance of their points from the center of the cluster
};
