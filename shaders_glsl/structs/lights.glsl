// Lamps and the clusters among which light sampling chooses.

const int NO_LIGHT = -1;
const int SEVERAL = -2;  // a cluster of several lamps, so of no single shape
const int SUN_LIGHT = -3;  // in place of the number of a lamp
const int SKY_LIGHT = -4;

const int PARTS = 8;  // parts of a cluster, among many lamps

struct Light {
    int shape;
    float share;  // of the flux of its part
    float keep;   // alias method: this light with probability `keep`, else its alias
    int alias;    // its part, an index into the clusters, << 16 | its alias
};

// A cluster of lamps that are close together. In a scene of few lamps, each lamp is a cluster. The clusters of many
// lamps are followed by PARTS of each, the parts of the first cluster first. A part holds the lamps from `first` on, or
// none.
struct Cluster {
    vec3 center;        // mean place of the flux
    float reach2;       // mean squared distance of their points from the center
    float probability;  // share of all flux
    int first;
    int count;
    int shape;          // shape of the lamp if there is one alone, else SEVERAL
};

// A target of particles that is not a sphere: a ball around another shape of smooth glass or metal.
struct Target {
    vec3 center;
    float radius;
};

// Distribution of the particles of a flat lamp over its sides, for particles that are not aimed.
struct Sides {
    float front;  // share of the particles that leave on the side of its normal
    float back;
    int spare_a;  // fill the row
    int spare_b;
};

// The directions into which the lamps of a cluster or a part emit: within a cone, at each of their points.
struct Aim {
    vec3 axis;    // unit; v is 1 - cos of the angle to it
    float outer;  // v from which on they emit nothing
    float slope;  // 1 over the length of v over which the emission falls
    float reach;  // largest distance of their points from the center of the cluster
};
