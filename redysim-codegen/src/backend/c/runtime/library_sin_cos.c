/* Sines and cosines of all angles, by the caller's macro or by math.h. */
#ifndef REDYSIM_SINCOS
#define REDYSIM_SINCOS(x, sine, cosine) (*(sine) = @sin@(x), *(cosine) = @cos@(x))
#endif
static void redysim_sin_cos(int count, const @number@ *angles, @number@ *sines, @number@ *cosines)
{
    for (int i = 0; i < count; i++) {
        REDYSIM_SINCOS(angles[i], &sines[i], &cosines[i]);
    }
}
