/* The functions of FMI 2.0 over the instance, with the types of the standard. */

typedef struct {
    void (*log)(void *environment, const char *name, status_t status, const char *category, const char *message, ...);
    void *(*allocate)(size_t count, size_t size);
    void (*free)(void *memory);
    void (*step_finished)(void *environment, status_t status);
    void *environment;
} callbacks_t;

typedef struct {
    int needs_update, terminates, changes_nominals, changes_states, has_next;
    double next;
} event_info_t;

typedef void (*log_message_t)(void *environment, const char *name, status_t status, const char *category, const char *message, ...);

static void log_message(const instance_t *instance, status_t status, const char *message)
{
    const log_message_t log = (log_message_t)instance->logger;
    if (log != NULL) {
        log(instance->environment, instance->name, status, status == DISCARD ? "logStatusDiscard" : "logStatusError", "%s",
            message);
    }
}

EXPORT const char *FMI(GetTypesPlatform)(void)
{
    return "default";
}

EXPORT const char *FMI(GetVersion)(void)
{
    return "2.0";
}

EXPORT status_t FMI(SetDebugLogging)(instance_t *instance, int is_on, size_t count, const char *const categories[])
{
    /* Faults are always logged, and there is nothing else to log. */
    return OK;
}

EXPORT instance_t *FMI(Instantiate)(const char *name, int type, const char *token, const char *resources,
    const callbacks_t *callbacks, int is_visible, int is_logging)
{
    instance_t given = {.is_co_simulation = type == 1, .log = log_message};
    if (callbacks != NULL) {
        given.environment = callbacks->environment;
        given.logger = (void (*)(void))callbacks->log;
    }
    return instantiate(given, name, token);
}

EXPORT status_t FMI(SetupExperiment)(instance_t *instance, int has_tolerance, double tolerance, double start, int has_stop,
    double stop)
{
    const status_t status = expect(instance, "SetupExperiment", INSTANTIATED);
    return status == OK ? enter_initialization(instance, has_tolerance, tolerance, start) : status;
}

EXPORT status_t FMI(EnterInitializationMode)(instance_t *instance)
{
    return enter(instance, "EnterInitializationMode", INSTANTIATED, INITIALIZING);
}

EXPORT status_t FMI(GetReal)(instance_t *instance, const unsigned references[], size_t count, double values[])
{
    return get(instance, references, count, values);
}

EXPORT status_t FMI(SetReal)(instance_t *instance, const unsigned references[], size_t count, const double values[])
{
    return set(instance, references, count, values);
}

/* There are no variables of other types. */
#define NO_VARIABLES(type, of) \
    EXPORT status_t FMI(Get##type)(instance_t *instance, const unsigned references[], size_t count, of values[]) \
    { \
        return count == 0 ? OK : report(instance, FAULT, "there are no variables of the type %s", #type); \
    } \
    EXPORT status_t FMI(Set##type)(instance_t *instance, const unsigned references[], size_t count, const of values[]) \
    { \
        return count == 0 ? OK : report(instance, FAULT, "there are no variables of the type %s", #type); \
    }

NO_VARIABLES(Integer, int)
NO_VARIABLES(Boolean, int)
typedef const char *string_t;
NO_VARIABLES(String, string_t)

UNSUPPORTED(GetDirectionalDerivative, const unsigned unknowns[], size_t unknown, const unsigned knowns[], size_t known,
    const double seed[], double sensitivity[])
UNSUPPORTED(SetRealInputDerivatives, const unsigned references[], size_t count, const int orders[], const double values[])
UNSUPPORTED(GetRealOutputDerivatives, const unsigned references[], size_t count, const int orders[], double values[])
UNSUPPORTED(GetStatus, int kind, status_t *value)
UNSUPPORTED(GetIntegerStatus, int kind, int *value)
UNSUPPORTED(GetBooleanStatus, int kind, int *value)
UNSUPPORTED(GetStringStatus, int kind, const char **value)

EXPORT status_t FMI(GetRealStatus)(instance_t *instance, int kind, double *value)
{
    /* The last successful time. */
    if (kind != 2) {
        return unsupported(instance, "GetRealStatus");
    }
    *value = instance->state.values[TIME];
    return OK;
}

EXPORT status_t FMI(CancelStep)(instance_t *instance)
{
    return unsupported(instance, "CancelStep");
}

EXPORT status_t FMI(NewDiscreteStates)(instance_t *instance, event_info_t *info)
{
    const event_info_t nothing = {0};
    *info = nothing;
    return expect(instance, "NewDiscreteStates", EVENTS);
}

EXPORT status_t FMI(CompletedIntegratorStep)(instance_t *instance, int is_final, int *has_event, int *terminates)
{
    *has_event = *terminates = 0;
    return expect(instance, "CompletedIntegratorStep", INTEGRATING);
}

EXPORT status_t FMI(GetDerivatives)(instance_t *instance, double derivatives[], size_t count)
{
    return get_states(instance, RATES, derivatives, count);
}

EXPORT status_t FMI(DoStep)(instance_t *instance, double time, double step, int is_final)
{
    double reached;
    return do_step(instance, time, step, &reached);
}
