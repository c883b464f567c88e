// A ray knows the shape that it leaves: it needs no offset and no tolerance.

struct Ray {
    vec3 origin;
    vec3 direction;  // unit
    int origin_shape;  // the shape that it starts on, or NO_SHAPE
    bool inward;     // whether it runs into the sphere, box or cylinder that it starts on
};
