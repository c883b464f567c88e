// The bounds of volumes.

// The medium behind the bounds of an object; `medium` itself if the object bounds nothing.
int medium_behind(int medium, int object, bool enters) {
    for (int i = 0; i < BOUNDARIES; ++i) {
        Boundary bounds = boundary_at(i);
        if (bounds.object == object) return enters ? bounds.inside : bounds.outside;
    }
    return medium;
}
