typedef union {
    @number@ number;
    uint@bits@_t bits;
} redysim_bits;

/* x = quarters * pi/2 + rest + tail, with |rest| <= pi/4. The last bits of `rounded` are the quarters. */
typedef struct {
    @number@ rounded;
    @number@ rest;
    @number@ tail;
} redysim_reduced;
