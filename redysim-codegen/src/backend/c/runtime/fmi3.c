/* The functions of FMI 3.0 over the instance, with the types of the standard. */

#include <stdbool.h>

typedef void (*log_message_t)(void *environment, status_t status, const char *category, const char *message);

static void log_message(const instance_t *instance, status_t status, const char *message)
{
    const log_message_t log = (log_message_t)instance->logger;
    if (log != NULL) {
        log(instance->environment, status, status == DISCARD ? "logStatusDiscard" : "logStatusError", message);
    }
}

static instance_t *instantiate_as(int is_co_simulation, const char *name, const char *token, void *environment, log_message_t log)
{
    const instance_t given = {.is_co_simulation = is_co_simulation, .environment = environment, .logger = (void (*)(void))log,
        .log = log_message};
    return instantiate(given, name, token);
}

EXPORT const char *FMI(GetVersion)(void)
{
    return "3.0";
}

EXPORT status_t FMI(SetDebugLogging)(instance_t *instance, bool is_on, size_t count, const char *const categories[])
{
    /* Faults are always logged, and there is nothing else to log. */
    return OK;
}

EXPORT instance_t *FMI(InstantiateModelExchange)(const char *name, const char *token, const char *resources, bool is_visible,
    bool is_logging, void *environment, log_message_t log)
{
    return instantiate_as(0, name, token, environment, log);
}

EXPORT instance_t *FMI(InstantiateCoSimulation)(const char *name, const char *token, const char *resources, bool is_visible,
    bool is_logging, bool has_events, bool may_return_early, const uint32_t intermediate[], size_t count, void *environment,
    log_message_t log, void (*update)(void))
{
    return instantiate_as(1, name, token, environment, log);
}

EXPORT instance_t *FMI(InstantiateScheduledExecution)(const char *name, const char *token, const char *resources, bool is_visible,
    bool is_logging, void *environment, log_message_t log, void (*clock)(void *), void (*lock)(void), void (*unlock)(void))
{
    if (log != NULL) {
        log(environment, FAULT, "logStatusError", "scheduled execution is not supported, as the model description states");
    }
    return NULL;
}

EXPORT status_t FMI(EnterInitializationMode)(instance_t *instance, bool has_tolerance, double tolerance, double start,
    bool has_stop, double stop)
{
    const status_t status = expect(instance, "EnterInitializationMode", INSTANTIATED);
    if (status != OK || enter_initialization(instance, has_tolerance, tolerance, start) != OK) {
        return FAULT;
    }
    instance->state.phase = INITIALIZING;
    return OK;
}

EXPORT status_t FMI(GetFloat64)(instance_t *instance, const uint32_t references[], size_t count, double values[], size_t size)
{
    return size == count ? get(instance, references, count, values)
                         : report(instance, FAULT, "all variables are scalars: %lu values for %lu variables", (unsigned long)size,
                             (unsigned long)count);
}

EXPORT status_t FMI(SetFloat64)(instance_t *instance, const uint32_t references[], size_t count, const double values[],
    size_t size)
{
    return size == count ? set(instance, references, count, values)
                         : report(instance, FAULT, "all variables are scalars: %lu values for %lu variables", (unsigned long)size,
                             (unsigned long)count);
}

/* There are no variables of other types. */
static status_t no_variables(const instance_t *instance, size_t count, const char *type)
{
    return count == 0 ? OK : report(instance, FAULT, "there are no variables of the type %s", type);
}

#define NO_VARIABLES(type, of) \
    EXPORT status_t FMI(Get##type)(instance_t *instance, const uint32_t references[], size_t count, of values[], size_t size) \
    { \
        return no_variables(instance, count, #type); \
    } \
    EXPORT status_t FMI(Set##type)(instance_t *instance, const uint32_t references[], size_t count, const of values[], \
        size_t size) \
    { \
        return no_variables(instance, count, #type); \
    }

NO_VARIABLES(Float32, float)
NO_VARIABLES(Int8, int8_t)
NO_VARIABLES(UInt8, uint8_t)
NO_VARIABLES(Int16, int16_t)
NO_VARIABLES(UInt16, uint16_t)
NO_VARIABLES(Int32, int32_t)
NO_VARIABLES(UInt32, uint32_t)
NO_VARIABLES(Int64, int64_t)
NO_VARIABLES(UInt64, uint64_t)
NO_VARIABLES(Boolean, bool)
typedef const char *string_t;
NO_VARIABLES(String, string_t)

EXPORT status_t FMI(GetBinary)(instance_t *instance, const uint32_t references[], size_t count, size_t sizes[],
    const uint8_t *values[], size_t size)
{
    return no_variables(instance, count, "Binary");
}

EXPORT status_t FMI(SetBinary)(instance_t *instance, const uint32_t references[], size_t count, const size_t sizes[],
    const uint8_t *const values[], size_t size)
{
    return no_variables(instance, count, "Binary");
}

EXPORT status_t FMI(GetClock)(instance_t *instance, const uint32_t references[], size_t count, bool values[])
{
    return no_variables(instance, count, "Clock");
}

EXPORT status_t FMI(SetClock)(instance_t *instance, const uint32_t references[], size_t count, const bool values[])
{
    return no_variables(instance, count, "Clock");
}

UNSUPPORTED(GetNumberOfVariableDependencies, uint32_t reference, size_t *count)
UNSUPPORTED(GetVariableDependencies, uint32_t dependent, size_t elements[], uint32_t independents[], size_t their_elements[],
    int kinds[], size_t count)
UNSUPPORTED(GetDirectionalDerivative, const uint32_t unknowns[], size_t unknown, const uint32_t knowns[], size_t known,
    const double seed[], size_t seeds, double sensitivity[], size_t sensitivities)
UNSUPPORTED(GetAdjointDerivative, const uint32_t unknowns[], size_t unknown, const uint32_t knowns[], size_t known,
    const double seed[], size_t seeds, double sensitivity[], size_t sensitivities)
UNSUPPORTED(GetIntervalDecimal, const uint32_t references[], size_t count, double intervals[], int qualifiers[])
UNSUPPORTED(GetIntervalFraction, const uint32_t references[], size_t count, uint64_t counters[], uint64_t resolutions[],
    int qualifiers[])
UNSUPPORTED(GetShiftDecimal, const uint32_t references[], size_t count, double shifts[])
UNSUPPORTED(GetShiftFraction, const uint32_t references[], size_t count, uint64_t counters[], uint64_t resolutions[])
UNSUPPORTED(SetIntervalDecimal, const uint32_t references[], size_t count, const double intervals[])
UNSUPPORTED(SetIntervalFraction, const uint32_t references[], size_t count, const uint64_t counters[],
    const uint64_t resolutions[])
UNSUPPORTED(SetShiftDecimal, const uint32_t references[], size_t count, const double shifts[])
UNSUPPORTED(SetShiftFraction, const uint32_t references[], size_t count, const uint64_t counters[],
    const uint64_t resolutions[])
UNSUPPORTED(GetOutputDerivatives, const uint32_t references[], size_t count, const int32_t orders[], double values[],
    size_t size)
UNSUPPORTED(ActivateModelPartition, uint32_t clock, double time)

EXPORT status_t FMI(EnterConfigurationMode)(instance_t *instance)
{
    return unsupported(instance, "EnterConfigurationMode");
}

EXPORT status_t FMI(ExitConfigurationMode)(instance_t *instance)
{
    return unsupported(instance, "ExitConfigurationMode");
}

EXPORT status_t FMI(EnterStepMode)(instance_t *instance)
{
    return unsupported(instance, "EnterStepMode");
}

EXPORT status_t FMI(EvaluateDiscreteStates)(instance_t *instance)
{
    return unsupported(instance, "EvaluateDiscreteStates");
}

EXPORT status_t FMI(UpdateDiscreteStates)(instance_t *instance, bool *needs_update, bool *terminates, bool *changes_nominals,
    bool *changes_states, bool *has_next, double *next)
{
    *needs_update = *terminates = *changes_nominals = *changes_states = *has_next = false;
    return expect(instance, "UpdateDiscreteStates", EVENTS);
}

EXPORT status_t FMI(CompletedIntegratorStep)(instance_t *instance, bool is_final, bool *has_event, bool *terminates)
{
    *has_event = *terminates = false;
    return expect(instance, "CompletedIntegratorStep", INTEGRATING);
}

EXPORT status_t FMI(GetContinuousStateDerivatives)(instance_t *instance, double derivatives[], size_t count)
{
    return get_states(instance, RATES, derivatives, count);
}

EXPORT status_t FMI(GetNumberOfContinuousStates)(instance_t *instance, size_t *count)
{
    *count = STATES;
    return OK;
}

EXPORT status_t FMI(GetNumberOfEventIndicators)(instance_t *instance, size_t *count)
{
    *count = 0;
    return OK;
}

EXPORT status_t FMI(DoStep)(instance_t *instance, double time, double step, bool is_final, bool *has_event, bool *terminates,
    bool *is_early, double *reached)
{
    *has_event = *terminates = *is_early = false;
    return do_step(instance, time, step, reached);
}
