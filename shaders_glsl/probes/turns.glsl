// Which probes an update is about, where SOME_PROBES: a run of an order that jumps over the grid.

// The probe that does work number `work` of an update; the number of probes if there is none.
int probe_in_turn(ProbeUpdate update, int work) {
    if (!SOME_PROBES) return work;
    if (work >= update.count) return frame.probe_count;
    return (update.first + work) * update.stride % frame.probe_count;
}
