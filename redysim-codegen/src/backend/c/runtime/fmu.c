/* The instance of an FMU: its variables, whose value references are their places among all values, the equations, and for
   co-simulation the method of Dormand and Prince of orders 5 and 4, whose steps are chosen from the tolerance. */

enum { STATES = @NAME@_NQ + @NAME@_NV, STAGES = 7, MOST_STEPS = 1000000 };

/* The first values of a status of FMI 2 and 3 are the same. */
typedef enum { OK, WARNING, DISCARD, FAULT } status_t;

typedef enum { INSTANTIATED, INITIALIZING, EVENTS, INTEGRATING, STEPPING, TERMINATED } phase_t;

/* All that changes; a copy of it is the state of the FMU. */
typedef struct {
    phase_t phase;
    double values[VARIABLES];
    @name@_t robot;
    /* Whether the robot has the parameters, and computed values are those of the other ones. */
    int has_parameters, is_computed;
    double tolerance, step;
} state_t;

typedef struct instance {
    state_t state;
    int is_co_simulation;
    char *name;
    void *environment;
    void (*logger)(void);
    void (*log)(const struct instance *instance, status_t status, const char *message);
} instance_t;

/* Logs why a call fails, and returns its status. */
static status_t report(const instance_t *instance, status_t status, const char *format, ...)
{
    char message[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    instance->log(instance, status, message);
    return status;
}

static void reset(instance_t *instance)
{
    const state_t fresh = {INSTANTIATED, {0}, {{0}}, 0, 0, DEFAULT_TOLERANCE, 0.0};
    instance->state = fresh;
    memcpy(instance->state.values, starts, sizeof starts);
}

/* An instance, or NULL. Its logger is set before. */
static instance_t *instantiate(instance_t given, const char *name, const char *token)
{
    instance_t *instance;
    given.name = (char *)(name ? name : "");
    if (token == NULL || strcmp(token, TOKEN) != 0) {
        report(&given, FAULT, "the token is %s, of another FMU; that of this one is %s", token ? token : "missing", TOKEN);
        return NULL;
    }
    instance = calloc(1, sizeof *instance);
    given.name = instance ? calloc(strlen(given.name) + 1, 1) : NULL;
    if (given.name == NULL) {
        free(instance);
        return NULL;
    }
    *instance = given;
    strcpy(instance->name, name ? name : "");
    reset(instance);
    return instance;
}

static void free_instance(instance_t *instance)
{
    if (instance != NULL) {
        free(instance->name);
        free(instance);
    }
}

/* Fails if the instance is not in a phase in which a function may be called. */
static status_t expect(const instance_t *instance, const char *function, phase_t phase)
{
    static const char *const phases[] = {"instantiated", "in initialization mode", "in event mode", "in continuous-time mode",
        "in step mode", "terminated"};
    if (instance->state.phase == phase) {
        return OK;
    }
    return report(instance, FAULT, "%s is called while the instance is %s, not %s", function, phases[instance->state.phase],
        phases[phase]);
}

static status_t enter(instance_t *instance, const char *function, phase_t from, phase_t to)
{
    const status_t status = expect(instance, function, from);
    if (status == OK) {
        instance->state.phase = to;
    }
    return status;
}

/* Takes the parameters, if a rigid body can have them. */
static status_t take_parameters(instance_t *instance)
{
    state_t *state = &instance->state;
    if (!state->has_parameters) {
        const int index = @name@_try_init(&state->robot, state->values + PARAMETERS);
        if (index != 0) {
            return report(instance, FAULT, "%s is %g and must be %s", names[PARAMETERS + index - 1],
                state->values[PARAMETERS + index - 1], @name@_parameter_rules[index - 1]);
        }
        state->has_parameters = 1;
    }
    return OK;
}

/* The rates of a state: of the coordinates, N(q) v, and of the velocities, the accelerations. */
static void rates(const state_t *state, const double *y, double *rates)
{
    @name@_coordinate_rates(&state->robot, y, y + @NAME@_NQ, rates);
    @name@_forward_dynamics(&state->robot, y, y + @NAME@_NQ, state->values + TAU, rates + @NAME@_NQ);
}

/* Computes what depends on other variables. */
static status_t compute(instance_t *instance)
{
    state_t *state = &instance->state;
    const status_t status = take_parameters(instance);
    if (status != OK) {
        return status;
    }
    if (!state->is_computed) {
        @name@_energy_t energy;
        rates(state, state->values + Q, state->values + RATES);
        @name@_energy(&state->robot, state->values + Q, state->values + V, &energy);
        state->values[ENERGY] = energy.kinetic;
        state->values[ENERGY + 1] = energy.potential;
        state->is_computed = 1;
    }
    for (size_t i = RATES; i < VARIABLES; i++) {
        if (!isfinite(state->values[i])) {
            return report(instance, DISCARD,
                "%s is not finite at %.17g s: the state is too large, a quaternion is zero, or a body has no inertia", names[i],
                state->values[TIME]);
        }
    }
    return OK;
}

static status_t get(instance_t *instance, const unsigned *references, size_t count, double *values)
{
    for (size_t i = 0; i < count; i++) {
        if (references[i] >= VARIABLES) {
            return report(instance, FAULT, "there is no variable with the value reference %u", references[i]);
        }
        if (references[i] >= RATES) {
            const status_t status = compute(instance);
            if (status != OK) {
                return status;
            }
        }
        values[i] = instance->state.values[references[i]];
    }
    return OK;
}

/* Sets all values, or none. */
static status_t set(instance_t *instance, const unsigned *references, size_t count, const double *values)
{
    state_t *state = &instance->state;
    for (size_t i = 0; i < count; i++) {
        const unsigned reference = references[i];
        if (reference >= VARIABLES) {
            return report(instance, FAULT, "there is no variable with the value reference %u", reference);
        }
        if (reference == TIME || reference >= RATES) {
            return report(instance, FAULT, "%s is computed and cannot be set", names[reference]);
        }
        if (state->phase > INITIALIZING && (reference < TAU || reference >= Q)) {
            return report(instance, FAULT, "%s can be set until the initialization ends", names[reference]);
        }
        if (!isfinite(values[i])) {
            return report(instance, FAULT, "%s must be a finite number, not %g", names[reference], values[i]);
        }
    }
    for (size_t i = 0; i < count; i++) {
        state->values[references[i]] = values[i];
        state->has_parameters = state->has_parameters && references[i] >= TAU;
    }
    state->is_computed = state->is_computed && count == 0;
    return OK;
}

static status_t enter_initialization(instance_t *instance, int has_tolerance, double tolerance, double start)
{
    state_t *state = &instance->state;
    if (!isfinite(start)) {
        return report(instance, FAULT, "the start time must be finite, not %g", start);
    }
    if (has_tolerance && !(tolerance > 0.0 && tolerance < 1.0)) {
        return report(instance, FAULT, "the tolerance must be between 0 and 1, not %g", tolerance);
    }
    state->tolerance = has_tolerance ? fmax(tolerance, LEAST_TOLERANCE) : DEFAULT_TOLERANCE;
    state->values[TIME] = start;
    return OK;
}

static status_t exit_initialization(instance_t *instance)
{
    status_t status = expect(instance, "ExitInitializationMode", INITIALIZING);
    if (status == OK) {
        status = compute(instance);
    }
    if (status == OK) {
        instance->state.phase = instance->is_co_simulation ? STEPPING : EVENTS;
    }
    return status == OK ? OK : FAULT;
}

static status_t set_time(instance_t *instance, double time)
{
    if (!isfinite(time)) {
        return report(instance, FAULT, "the time must be finite, not %g", time);
    }
    instance->state.values[TIME] = time;
    return OK;
}

static status_t set_states(instance_t *instance, const double *y, size_t count)
{
    status_t status = expect(instance, "SetContinuousStates", INTEGRATING);
    if (status == OK && count != STATES) {
        status = report(instance, FAULT, "there are %d continuous states, not %lu", (int)STATES, (unsigned long)count);
    }
    for (size_t i = 0; status == OK && i < STATES; i++) {
        if (!isfinite(y[i])) {
            status = report(instance, DISCARD, "%s must be a finite number, not %g", names[Q + i], y[i]);
        }
    }
    if (status == OK) {
        memcpy(instance->state.values + Q, y, STATES * sizeof *y);
        instance->state.is_computed = 0;
    }
    return status;
}

/* Values from a place on, of which there are STATES. */
static status_t get_states(instance_t *instance, size_t from, double *values, size_t count)
{
    status_t status = OK;
    if (count != STATES) {
        return report(instance, FAULT, "there are %d continuous states, not %lu", (int)STATES, (unsigned long)count);
    }
    if (from >= RATES) {
        status = compute(instance);
    }
    memcpy(values, instance->state.values + from, STATES * sizeof *values);
    return status;
}

static status_t get_nominals(instance_t *instance, double *nominals, size_t count)
{
    if (count != STATES) {
        return report(instance, FAULT, "there are %d continuous states, not %lu", (int)STATES, (unsigned long)count);
    }
    for (size_t i = 0; i < count; i++) {
        nominals[i] = 1.0;
    }
    return OK;
}

static status_t copy_state(instance_t *instance, state_t **copy)
{
    if (*copy == NULL && (*copy = malloc(sizeof **copy)) == NULL) {
        return report(instance, FAULT, "there is no memory for a state of the FMU");
    }
    **copy = instance->state;
    return OK;
}

static status_t expect_size(const instance_t *instance, size_t size)
{
    return size == sizeof(state_t) ? OK : report(instance, FAULT, "a state of this FMU has %lu bytes, not %lu",
        (unsigned long)sizeof(state_t), (unsigned long)size);
}

/* The stages after the first, and the weights of the estimated error: J. R. Dormand and P. J. Prince, J. Comput. Appl. Math. 6
   (1980), table 2. */
static const double stages[STAGES - 1][STAGES - 1] = {
    {1.0 / 5.0},
    {3.0 / 40.0, 9.0 / 40.0},
    {44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0},
    {19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0},
    {9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0},
    {35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0},
};
static const double errors[STAGES] = {71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339200.0, 22.0 / 525.0,
    -1.0 / 40.0};

/* The tolerance of a component: relative, and absolute where it is less than 1. */
static double scale(const state_t *state, double a, double b)
{
    return state->tolerance * fmax(1.0, fmax(fabs(a), fabs(b)));
}

/* The largest relative rate, for the first step. */
static double speed(const double *y, const double *rate)
{
    double largest = 0.0;
    for (size_t i = 0; i < STATES; i++) {
        largest = fmax(largest, fabs(rate[i]) / fmax(1.0, fabs(y[i])));
    }
    return largest;
}

/* One step: the state at its end, its rates there, and the estimated error in units of the tolerance. */
static double try_step(const state_t *state, double step, const double *y, double k[STAGES][STATES], double *end)
{
    double error = 0.0;
    for (int stage = 1; stage < STAGES; stage++) {
        for (size_t i = 0; i < STATES; i++) {
            double sum = 0.0;
            for (int j = 0; j < stage; j++) {
                sum += stages[stage - 1][j] * k[j][i];
            }
            end[i] = y[i] + step * sum;
        }
        rates(state, end, k[stage]);
    }
    for (size_t i = 0; i < STATES; i++) {
        double difference = 0.0;
        for (int j = 0; j < STAGES; j++) {
            difference += errors[j] * k[j][i];
        }
        difference = fabs(step * difference) / scale(state, y[i], end[i]);
        /* A number that is not finite stays. */
        error = difference <= error ? error : difference;
    }
    return error;
}

/* Quaternions stay of length 1. */
static void normalize(double *y)
{
    for (const size_t *first = quaternions; first != quaternions + QUATERNIONS; first++) {
        double *quaternion = y + *first;
        double square = 0.0;
        for (int j = 0; j < 4; j++) {
            square += quaternion[j] * quaternion[j];
        }
        for (int j = 0; j < 4; j++) {
            quaternion[j] /= sqrt(square);
        }
    }
}

/* Integrates to the end, or as far as steps succeed: `time` is where. */
static status_t do_step(instance_t *instance, double from, double length, double *time)
{
    state_t *state = &instance->state;
    double k[STAGES][STATES], next[STATES], *y = state->values + Q, end = from + length;
    status_t status = expect(instance, "DoStep", STEPPING);
    *time = state->values[TIME];
    if (status == OK) {
        status = compute(instance);
    }
    if (status != OK) {
        return status;
    }
    if (!(length >= 0.0) || !isfinite(end) || fabs(from - *time) > 1e-9 * fmax(1.0, fabs(*time))) {
        return report(instance, FAULT, "a step from %.17g s by %g s cannot follow %.17g s", from, length, *time);
    }
    rates(state, y, k[0]);
    if (!(state->step > 0.0)) {
        state->step = 0.01 / fmax(speed(y, k[0]), 1.0);
    }
    for (int steps = 0; *time < end; steps++) {
        const double left = end - *time;
        const int is_last = 1.000001 * state->step >= left;
        const double step = is_last ? left : state->step;
        const double error = try_step(state, step, y, k, next);
        /* The order is 5; from a state that is not finite, steps become shorter. */
        const double factor = isfinite(error) ? fmin(5.0, fmax(0.2, 0.9 * pow(fmax(error, 1e-10), -0.2))) : 0.2;
        if (steps >= MOST_STEPS) {
            return report(instance, DISCARD, "the integration stops at %.17g s, after %d steps", *time, (int)MOST_STEPS);
        }
        if (error <= 1.0) {
            normalize(next);
            memcpy(y, next, sizeof next);
            *time = is_last ? end : *time + step;
            state->values[TIME] = *time;
            state->is_computed = 0;
            if (QUATERNIONS > 0) {
                rates(state, y, k[0]);
            } else {
                memcpy(k[0], k[STAGES - 1], sizeof k[0]);
            }
            /* A step that ends early tells little about the next. */
            if (!is_last || factor * step > state->step) {
                state->step = factor * step;
            }
            continue;
        }
        state->step = fmin(factor, 0.9) * step;
        if (state->step <= 4.0 * DBL_EPSILON * fmax(fabs(*time), DBL_MIN / DBL_EPSILON)) {
            return report(instance, DISCARD, "the integration stops at %.17g s: steps of %g s do not meet the tolerance of %g", *time,
                state->step, state->tolerance);
        }
    }
    return compute(instance);
}
