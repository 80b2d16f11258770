/*
 * @count@ branches that are alike: in a vector, or one after the other. An array for several branches has REDYSIM_@NAME@S of them.
 */
#if REDYSIM_VECTORS
@vector@
#define REDYSIM_@NAME@_SQUARE_ROOT(a) redysim_@name@_square_root((const redysim_@name@[]){REDYSIM_@NAME@_ALL(a)})

REDYSIM_INLINE redysim_@name@ redysim_@name@_square_root(const redysim_@name@ *a)
{
    redysim_@name@ root = *a;
    for (int i = 0; i < @count@; i++) {
        root[i] = @sqrt@(root[i]);
    }
    return root;
}

#define REDYSIM_@NAME@(@places@) {@places@}
#define REDYSIM_@NAME@S(count) (((count) + @count@ - 1) / @count@)
#define REDYSIM_@NAME@_AT(array, branch) ((array)[(branch) / @count@][(branch) % @count@])
#else
typedef @number@ redysim_@name@;

#define REDYSIM_@NAME@_SQUARE_ROOT @sqrt@
#define REDYSIM_@NAME@_ALL(x) (x)
#define REDYSIM_@NAME@_MULTIPLY_ADD MULTIPLY_ADD
#define REDYSIM_@NAME@(@places@) @places@
#define REDYSIM_@NAME@S(count) (count)
#define REDYSIM_@NAME@_AT(array, branch) ((array)[branch])
#endif
