// Input of one update of the probes (glrt/rendering/probe_tracer.py).

const int MOST_PROBE_RAYS = 256;  // rays of one probe in one update
const float WRONG_FACE = -0.2;    // of the distance to a wrong face of a solid in the rays: probes seem near it

struct ProbeUpdate {
    int rays;     // of each probe
    int number;   // of the update
    uint seed;    // of the set of probes
    int purpose;  // of the rays
    float kept;   // share of the value before that a map keeps (hysteresis)
    int first;    // place in the order of the first probe that is updated
    int count;    // how many are updated
    int stride;   // step from probe to probe in that order: prime to the number of probes
};

// Purposes of the rays. Rays that look for surfaces bring no light.
const int FOR_LIGHT = 0;
const int FOR_DISTANCES = 1;
const int FOR_PUSHES = 2;
const int FOR_USE = 3;  // whether a probe can be used
