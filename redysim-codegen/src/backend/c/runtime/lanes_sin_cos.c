/* Sines and cosines of angles in lanes; where one of them needs the slow path, one after the other. */
REDYSIM_SHARED void redysim_lanes_sin_cos(
    int count, const redysim_lanes *angles, redysim_lanes *sines, redysim_lanes *cosines)
{
    redysim_lanes_bits inaccurate = {0};
    uint64_t any = 0U;
    for (int i = 0; i < count; i++) {
        redysim_lanes rounded, rest, tail;
        inaccurate |= redysim_lanes_fast_reduction(angles[i], &rounded, &rest, &tail);
        redysim_lanes_evaluate(rounded, rest, tail, &sines[i], &cosines[i]);
    }
    for (int lane = 0; lane < REDYSIM_LANES; lane++) {
        any |= inaccurate[lane];
    }
    if (any >> 63) {
        redysim_slow_sin_cos(
            count * REDYSIM_LANES, (const double *)angles, (double *)sines, (double *)cosines);
    }
}

static inline redysim_lanes redysim_lanes_sine(redysim_lanes angle)
{
    redysim_lanes sine, cosine;
    redysim_lanes_sin_cos(1, &angle, &sine, &cosine);
    return sine;
}

static inline redysim_lanes redysim_lanes_cosine(redysim_lanes angle)
{
    redysim_lanes sine, cosine;
    redysim_lanes_sin_cos(1, &angle, &sine, &cosine);
    return cosine;
}
