static inline uint@bits@_t redysim_bits_of(@number@ x)
{
    redysim_bits number;
    number.number = x;
    return number.bits;
}

static inline @number@ redysim_number_of(uint@bits@_t bits)
{
    redysim_bits number;
    number.bits = bits;
    return number.number;
}
