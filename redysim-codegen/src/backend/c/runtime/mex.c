/* Reports a fault to MATLAB or Octave, which names the gateway and goes on. */
#define FAULT(kind, ...) mexErrMsgIdAndTxt("redysim:" kind, __VA_ARGS__)

/* How many numbers an array has for each state. */
static size_t length_of(const shape_t *shape)
{
    return shape->rows * (shape->columns == 0 ? 1 : shape->columns);
}

/* Whether an array has one state or, in its last dimension, several. Vectors may be rows. */
static int has_shape(const shape_t *shape, const mxArray *array, size_t *states)
{
    const size_t dimensions = (size_t)mxGetNumberOfDimensions(array);
    const mwSize *sizes = mxGetDimensions(array);
    const size_t rows = (size_t)sizes[0], columns = (size_t)sizes[1];
    if (shape->columns > 0) {
        *states = dimensions > 2 ? (size_t)sizes[2] : 1;
        return dimensions <= 3 && rows == shape->rows && columns == shape->columns;
    }
    if (dimensions > 2) {
        return 0;
    }
    /* Of one coordinate, a row has a state in each column. */
    *states = rows == shape->rows ? columns : 1;
    return rows == shape->rows || (rows == 1 && columns == shape->rows);
}

/* The numbers of an argument, one state after the other. */
static const double *numbers_of(const char *function, const shape_t *shape, const mxArray *array, size_t *states)
{
    const size_t length = length_of(shape);
    const double *numbers;
    if (!mxIsDouble(array) || mxIsComplex(array) || mxIsSparse(array)) {
        FAULT("type", "%s of %s must be a full array of real doubles, not %s%s%s", shape->name, function,
            mxIsSparse(array) ? "sparse " : "", mxIsComplex(array) ? "complex " : "", mxGetClassName(array));
    }
    if (!has_shape(shape, array, states)) {
        const mwSize *sizes = mxGetDimensions(array);
        FAULT("shape", "%s of %s must be %lu by %lu, or have a state in each %s; it is %lu by %lu%s", shape->name, function,
            (unsigned long)shape->rows, (unsigned long)(shape->columns == 0 ? 1 : shape->columns),
            shape->columns == 0 ? "column" : "page", (unsigned long)sizes[0], (unsigned long)sizes[1],
            mxGetNumberOfDimensions(array) > 2 ? " by more" : "");
    }
    numbers = mxGetPr(array);
    for (size_t i = 0; i < *states * length; i++) {
        if (!isfinite(numbers[i])) {
            FAULT("value", "%s of %s must have finite numbers; number %lu of state %lu is %g", shape->name, function,
                (unsigned long)(i % length + 1), (unsigned long)(i / length + 1), numbers[i]);
        }
    }
    return numbers;
}

/* An array of zeros for a number of states, which are its last dimension. */
static mxArray *array_of(const shape_t *shape, size_t states)
{
    const mwSize sizes[3] = {(mwSize)shape->rows, (mwSize)(shape->columns == 0 ? states : shape->columns), (mwSize)states};
    return mxCreateNumericArray(shape->columns == 0 || states == 1 ? 2 : 3, sizes, mxDOUBLE_CLASS, mxREAL);
}

/* Copies the numbers of one state, which are by rows, into an array, in which they are by columns. */
static const double *store(const shape_t *shape, const double *numbers, mxArray *array, size_t state)
{
    double *to = mxGetPr(array) + state * length_of(shape);
    const size_t columns = shape->columns == 0 ? 1 : shape->columns;
    for (size_t row = 0; row < shape->rows; row++) {
        for (size_t column = 0; column < columns; column++) {
            to[column * shape->rows + row] = *numbers++;
        }
    }
    return numbers;
}

/* The result of a function for all states: an array, or structs of arrays. */
static mxArray *result_of(const function_t *function, const void *robot, const mxArray **arguments)
{
    const double *given[MOST_ARGUMENTS] = {0}, *at[MOST_ARGUMENTS] = {0};
    size_t steps[MOST_ARGUMENTS] = {0}, states = 1, length = 0;
    const int is_struct = function->parts[0].name != NULL;
    mxArray *result = NULL, *arrays[MOST_ARRAYS];
    double *numbers;
    for (size_t i = 0; i < function->arguments; i++) {
        size_t own = 1;
        given[i] = numbers_of(function->name, &function->argument[i], arguments[i], &own);
        if (own != 1 && states != 1 && own != states) {
            FAULT("shape", "%s of %s has %lu states, an argument before it %lu", function->argument[i].name, function->name,
                (unsigned long)own, (unsigned long)states);
        }
        states = own == 1 ? states : own;
        steps[i] = own == 1 ? 0 : length_of(&function->argument[i]);
    }
    if (is_struct) {
        const char *fields[MOST_PARTS];
        for (size_t part = 0; part < function->count; part++) {
            fields[part] = function->parts[part].name;
        }
        result = mxCreateStructMatrix((mwSize)function->elements, 1, (int)function->count, fields);
    }
    for (size_t i = 0; i < function->elements * function->count; i++) {
        const shape_t *part = &function->parts[i % function->count];
        arrays[i] = array_of(part, states);
        length += length_of(part);
        if (is_struct) {
            mxSetFieldByNumber(result, (mwIndex)(i / function->count), (int)(i % function->count), arrays[i]);
        }
    }
    numbers = mxCalloc(length, sizeof *numbers);
    for (size_t state = 0; state < states; state++) {
        const double *next = numbers;
        for (size_t i = 0; i < function->arguments; i++) {
            at[i] = given[i] + state * steps[i];
        }
        function->call(robot, at, numbers);
        for (size_t i = 0; i < length; i++) {
            if (!isfinite(numbers[i])) {
                FAULT("result", "%s has no finite result at state %lu: numbers are too large, or a body has no inertia",
                    function->name, (unsigned long)(state + 1));
            }
        }
        for (size_t i = 0; i < function->elements * function->count; i++) {
            next = store(&function->parts[i % function->count], next, arrays[i], state);
        }
    }
    mxFree(numbers);
    return is_struct ? result : arrays[0];
}

/* Names, units and parameters of the model. */
static mxArray *model(void)
{
    mxArray *result = mxCreateStructMatrix(1, 1, 0, NULL);
    mxSetFieldByNumber(result, 0, mxAddField(result, "name"), mxCreateString(@NAME@_NAME));
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        mxArray *cells = mxCreateCellMatrix((mwSize)names[i].length, 1);
        for (size_t j = 0; j < names[i].length; j++) {
            mxSetCell(cells, (mwIndex)j, mxCreateString(names[i].texts[j]));
        }
        mxSetFieldByNumber(result, 0, mxAddField(result, names[i].name), cells);
    }
#if @NAME@_NP > 0
    {
        const shape_t shape = {"parameters", @NAME@_NP, 0};
        mxArray *values = array_of(&shape, 1);
        store(&shape, @name@_parameters, values, 0);
        mxSetFieldByNumber(result, 0, mxAddField(result, "parameters"), values);
    }
#endif
    return result;
}

void mexFunction(int results, mxArray **result, int count, const mxArray **arguments)
{
    const function_t *function = functions, *const end = functions + sizeof functions / sizeof *functions;
    const void *robot = NULL;
    char name[64] = "";
    size_t given = (size_t)(count > 0 ? count - 1 : 0);
    if (count < 1 || !mxIsChar(arguments[0])) {
        FAULT("function", "the first argument must be the name of a function, such as '%s'; see help @name@", functions->name);
    }
    /* A name that is too long is that of no function, either. */
    (void)mxGetString(arguments[0], name, sizeof name);
    if (results > 1) {
        FAULT("arguments", "%s gives one result, not %d", name, results);
    }
    if (strcmp(name, "model") == 0 && given == 0) {
        result[0] = model();
        return;
    }
    while (function < end && strcmp(function->name, name) != 0) {
        function++;
    }
    if (function == end) {
        FAULT("function", "there is no function '%s'; see help @name@", name);
    }
#if @NAME@_NP > 0
    @name@_t with_parameters;
    @name@_default(&with_parameters);
    if (given == function->arguments + 1) {
        const shape_t shape = {"parameters", @NAME@_NP, 0};
        size_t robots;
        const double *parameters = numbers_of(name, &shape, arguments[given], &robots);
        int status;
        if (robots != 1) {
            FAULT("shape", "parameters of %s must be those of one robot, not of %lu", name, (unsigned long)robots);
        }
        status = @name@_try_init(&with_parameters, parameters);
        if (status != 0) {
            FAULT("parameters", "%s must be %s", @name@_parameter_names[status - 1], @name@_parameter_rules[status - 1]);
        }
        given--;
    }
    robot = &with_parameters;
#endif
    if (given != function->arguments) {
        FAULT("arguments", "%s takes %lu arguments%s, not %lu; see help @name@", name, (unsigned long)function->arguments,
            @NAME@_NP > 0 ? " and may take parameters" : "", (unsigned long)given);
    }
    result[0] = result_of(function, robot, arguments + 1);
}
