/* Angles one after the other, of which some need the slow path. */
REDYSIM_COLD void redysim_slow_sin_cos(int count, const @number@ *angles, @number@ *sines, @number@ *cosines)
{
    for (int i = 0; i < count; i++) {
        redysim_reduced angle;
        if (redysim_fast_reduction(angles[i], &angle.rounded, &angle.rest, &angle.tail) >> (@bits@ - 1)) {
            angle = redysim_reduce(angles[i]);
        }
        redysim_evaluate(angle.rounded, angle.rest, angle.tail, &sines[i], &cosines[i]);
    }
}

#if REDYSIM_GROUP > 1
@group_type@
#if defined(__clang__) && (defined(__x86_64__) || defined(__aarch64__))
#define REDYSIM_PRESERVING __attribute__((preserve_most))
#else
#define REDYSIM_PRESERVING
#endif

/*
 * Those of a group of which some need the slow path. It is passed as a value, so that angles need not be stored for it, and registers are
 * left to the caller, which else would have to save its arguments from a function that it hardly ever calls.
 */
REDYSIM_COLD REDYSIM_PRESERVING void redysim_slow_sin_cos_of_group(redysim_group group, @number@ *sines, @number@ *cosines)
{
    @number@ angles[REDYSIM_GROUP];
    for (int place = 0; place < REDYSIM_GROUP; place++) {
        angles[place] = group[place];
    }
    redysim_slow_sin_cos(REDYSIM_GROUP, angles, sines, cosines);
}

/* The angles from number `first` on; places without an angle repeat the last one. */
REDYSIM_INLINE redysim_group redysim_group_of(int first, int count, const @number@ *angles)
{
    redysim_group group;
    for (int place = 0; place < REDYSIM_GROUP; place++) {
        group[place] = angles[first + place < count ? first + place : count - 1];
    }
    return group;
}

/* Whether the first bit of an element is set. */
REDYSIM_INLINE int redysim_group_any(redysim_group_bits bits)
{
#if defined(__AVX__)
    return !@none_256@((@x86_256@)bits, (@x86_256@)bits);
#elif defined(__SSE2__)
    return @any_128@((@x86_128@)bits);
#else
    uint@bits@_t any = 0U;
    for (int place = 0; place < REDYSIM_GROUP; place++) {
        any |= bits[place];
    }
    return (int)(any >> (@bits@ - 1));
#endif
}

/* Sines and cosines of angles, in arrays with room for whole groups. */
REDYSIM_INLINE void redysim_sin_cos(int count, const @number@ *angles, @number@ *sines, @number@ *cosines)
{
    redysim_group_bits inaccurate = {0};
    for (int i = 0; i < count; i += REDYSIM_GROUP) {
        redysim_group rounded, rest, tail, sine, cosine;
        inaccurate |= redysim_group_fast_reduction(redysim_group_of(i, count, angles), &rounded, &rest, &tail);
        redysim_group_evaluate(rounded, rest, tail, &sine, &cosine);
        for (int place = 0; place < REDYSIM_GROUP; place++) {
            sines[i + place] = sine[place];
            cosines[i + place] = cosine[place];
        }
    }
    if (redysim_group_any(inaccurate)) {
        for (int i = 0; i < count; i += REDYSIM_GROUP) {
            @number@ some_sines[REDYSIM_GROUP], some_cosines[REDYSIM_GROUP];
            redysim_slow_sin_cos_of_group(redysim_group_of(i, count, angles), some_sines, some_cosines);
            for (int place = 0; place < REDYSIM_GROUP; place++) {
                sines[i + place] = some_sines[place];
                cosines[i + place] = some_cosines[place];
            }
        }
    }
}
#else
/* Sines and cosines of angles, with one branch, by which all are computed again if one of them needs the slow path. */
REDYSIM_SHARED void redysim_sin_cos(
    int count, const @number@ *restrict angles, @number@ *restrict sines, @number@ *restrict cosines)
{
    uint@bits@_t inaccurate = 0U;
    for (int i = 0; i < count; i++) {
        @number@ rounded, rest, tail;
        inaccurate |= redysim_fast_reduction(angles[i], &rounded, &rest, &tail);
        redysim_evaluate(rounded, rest, tail, &sines[i], &cosines[i]);
    }
    if (inaccurate >> (@bits@ - 1)) {
        redysim_slow_sin_cos(count, angles, sines, cosines);
    }
}
#endif
