static inline @number@ redysim_@which@(@number@ angle)
{
    @number@ sines[REDYSIM_GROUP], cosines[REDYSIM_GROUP];
    redysim_sin_cos(1, &angle, sines, cosines);
    return @which@s[0];
}
