// The bounds of volumes. Volumes lie apart or one in another, so that each side of a surface has its medium.
//
// HAS_RANKS: volumes overlap by priority. Then a path has a bit for each volume around it. The rows of bounds stand in
// ascending order of rank (glrt/scene/volumes.py), so that the highest bit is that of the volume that holds the place.

// The row of the bounds of an object; -1 if the object bounds nothing.
int bounds_of(int object) {
    for (int i = 0; i < BOUNDARIES; ++i) {
        if (boundary_at(i).object == object) return i;
    }
    return -1;
}

// The medium behind the bounds of an object; `medium` itself if the object bounds nothing.
int medium_behind(int medium, int object, bool enters) {
    for (int i = 0; i < BOUNDARIES; ++i) {
        Boundary bounds = boundary_at(i);
        if (bounds.object == object) return enters ? bounds.inside : bounds.outside;
    }
    return medium;
}

// The medium where these volumes overlap.
int medium_of(uint volumes) {
    if (volumes == 0u) return boundary_at(0).outside;
    return boundary_at(findMSB(volumes)).inside;
}

// The row of the highest of these volumes that is of glass; -1 if none is.
int glass_of(uint volumes) {
    for (int i = BOUNDARIES - 1; i >= 0; --i) {
        if ((volumes >> uint(i) & 1u) != 0u && boundary_at(i).ior > 0.0) return i;
    }
    return -1;
}

// The index of refraction where these volumes overlap, against air.
float ior_of(uint volumes) {
    int glass = glass_of(volumes);
    if (glass < 0) return 1.0;
    return boundary_at(glass).ior;
}

// Whether the glass of an object gives way to that of a higher rank: then its surface is not there.
bool is_displaced(uint volumes, int object) {
    if (!HAS_RANKS) return false;
    int row = bounds_of(object);
    return row >= 0 && boundary_at(row).ior > 0.0 && glass_of(volumes) > row;
}

// Crosses the surface of an object: the medium and the volumes on the other side.
void cross_bounds(inout int medium, inout uint volumes, int object, bool enters) {
    if (!HAS_RANKS) {
        medium = medium_behind(medium, object, enters);
        return;
    }
    int row = bounds_of(object);
    if (row < 0) return;
    uint own = 1u << uint(row);
    volumes = enters ? volumes | own : volumes & ~own;
    medium = medium_of(volumes);
}
