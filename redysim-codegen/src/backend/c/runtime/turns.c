/*
 * Angles of more than 7 rad without whole turns, for sums of angles: these would else be rounded to the digits of their
 * size, and so would their sines.
 */
REDYSIM_COLD void redysim_without_turns_of_large(int count, @number@ *angles)
{
    for (int i = 0; i < count; i++) {
        if (!(angles[i] >= -@seven@ && angles[i] <= @seven@)) {
            const redysim_reduced reduced = redysim_reduce(angles[i]);
            /* How many quarter turns there are, by the last bits: -1, 0, 1 or 2. */
            const uint@bits@_t turns = redysim_bits_of(reduced.rounded) & 3U;
            const @number@ quarters = turns == 3U ? -@one@ : (@number@)turns;
            angles[i] = quarters * @half_pi@ + (reduced.rest + (reduced.tail + quarters * @half_pi_rest@));
        }
    }
}

static inline void redysim_without_turns(int count, @number@ *angles)
{
    uint@bits@_t large = 0U;
    for (int i = 0; i < count; i++) {
        large |= redysim_bits_of(@seven@ * @seven@ - angles[i] * angles[i]);
    }
    if (large >> (@bits@ - 1)) {
        redysim_without_turns_of_large(count, angles);
    }
}
