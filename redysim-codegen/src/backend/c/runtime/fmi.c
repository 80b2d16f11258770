/* What FMI 2.0 and 3.0 have in common, over the instance. */

#define JOIN_NAMES(a, b) a##b
#define JOIN(a, b) JOIN_NAMES(a, b)
#if defined(FMI@version@_FUNCTION_PREFIX) && !defined(FMI@version@_OVERRIDE_FUNCTION_PREFIX)
#define FMI(name) JOIN(FMI@version@_FUNCTION_PREFIX, fmi@version@##name)
#else
#define FMI(name) fmi@version@##name
#endif

static status_t unsupported(const instance_t *instance, const char *function)
{
    return report(instance, FAULT, "%s is not supported, as the model description states", function);
}

/* For what the model description does not offer: the arguments after the instance are not read. */
#define UNSUPPORTED(name, ...) \
    EXPORT status_t FMI(name)(instance_t *instance, __VA_ARGS__) \
    { \
        return unsupported(instance, #name); \
    }

EXPORT void FMI(FreeInstance)(instance_t *instance)
{
    free_instance(instance);
}

EXPORT status_t FMI(ExitInitializationMode)(instance_t *instance)
{
    return exit_initialization(instance);
}

EXPORT status_t FMI(EnterEventMode)(instance_t *instance)
{
    return enter(instance, "EnterEventMode", INTEGRATING, EVENTS);
}

EXPORT status_t FMI(EnterContinuousTimeMode)(instance_t *instance)
{
    return enter(instance, "EnterContinuousTimeMode", EVENTS, INTEGRATING);
}

EXPORT status_t FMI(Terminate)(instance_t *instance)
{
    instance->state.phase = TERMINATED;
    return OK;
}

EXPORT status_t FMI(Reset)(instance_t *instance)
{
    reset(instance);
    return OK;
}

EXPORT status_t FMI(SetTime)(instance_t *instance, double time)
{
    return set_time(instance, time);
}

EXPORT status_t FMI(SetContinuousStates)(instance_t *instance, const double states[], size_t count)
{
    return set_states(instance, states, count);
}

EXPORT status_t FMI(GetContinuousStates)(instance_t *instance, double states[], size_t count)
{
    return get_states(instance, Q, states, count);
}

EXPORT status_t FMI(GetNominalsOfContinuousStates)(instance_t *instance, double nominals[], size_t count)
{
    return get_nominals(instance, nominals, count);
}

EXPORT status_t FMI(GetEventIndicators)(instance_t *instance, double indicators[], size_t count)
{
    return count == 0 ? OK : unsupported(instance, "GetEventIndicators");
}

EXPORT status_t FMI(Get@FMUState@)(instance_t *instance, state_t **state)
{
    return copy_state(instance, state);
}

EXPORT status_t FMI(Set@FMUState@)(instance_t *instance, const state_t *state)
{
    instance->state = *state;
    return OK;
}

EXPORT status_t FMI(Free@FMUState@)(instance_t *instance, state_t **state)
{
    free(*state);
    *state = NULL;
    return OK;
}

EXPORT status_t FMI(Serialized@FMUState@Size)(instance_t *instance, const state_t *state, size_t *size)
{
    *size = sizeof *state;
    return OK;
}

EXPORT status_t FMI(Serialize@FMUState@)(instance_t *instance, const state_t *state, @byte@ bytes[], size_t size)
{
    const status_t status = expect_size(instance, size);
    if (status == OK) {
        memcpy(bytes, state, size);
    }
    return status;
}

EXPORT status_t FMI(@Deserialize@@FMUState@)(instance_t *instance, const @byte@ bytes[], size_t size, state_t **state)
{
    status_t status = expect_size(instance, size);
    if (status == OK) {
        status = copy_state(instance, state);
    }
    if (status == OK) {
        memcpy(*state, bytes, size);
    }
    return status;
}
