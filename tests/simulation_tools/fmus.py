"""FMUs are valid, simulate to the reference by both interfaces, and report what is wrong. Arguments: the folder with the FMUs,
and that of the references."""

import sys
import zipfile
from ctypes import POINTER, c_double
from pathlib import Path

import numpy as np
from fmpy import extract, read_model_description, simulate_fmu
from fmpy.build import build_platform_binary
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Model, FMU2Slave
from fmpy.fmi3 import FMU3Model, FMU3Slave
from fmpy.validation import validate_fmu

made, references = map(Path, sys.argv[1:])
OK, DISCARD, ERROR = 0, 2, 3
INTERFACES = ["CoSimulation", "ModelExchange"]


class Instance:
    """An instance of an FMU, with what it logs."""

    def __init__(self, fmu, interface):
        self.folder = extract(str(fmu))
        self.description = read_model_description(self.folder)
        self.is_3 = self.description.fmiVersion == "3.0"
        self.references = {variable.name: variable.valueReference for variable in self.description.modelVariables}
        self.messages = []
        kinds = {(True, 0): FMU3Slave, (True, 1): FMU3Model, (False, 0): FMU2Slave, (False, 1): FMU2Model}
        make = kinds[self.is_3, INTERFACES.index(interface)]
        identifier = self.description.coSimulation.modelIdentifier
        self.fmu = make(guid=self.description.guid, unzipDirectory=self.folder, modelIdentifier=identifier,
                        instanceName="one")
        if self.is_3:
            self.fmu.instantiate(logMessage=lambda environment, status, category, message: self.log(status, message))
        else:
            from fmpy.fmi2 import (fmi2CallbackAllocateMemoryTYPE, fmi2CallbackFreeMemoryTYPE, fmi2CallbackFunctions,
                                   fmi2CallbackLoggerTYPE, fmi2StepFinishedTYPE)
            self.callbacks = fmi2CallbackFunctions()
            # The text of the format is the one argument that follows.
            self.callbacks.logger = fmi2CallbackLoggerTYPE(
                lambda environment, name, status, category, format: self.log(status, format))
            self.callbacks.allocateMemory = fmi2CallbackAllocateMemoryTYPE(lambda count, size: None)
            self.callbacks.freeMemory = fmi2CallbackFreeMemoryTYPE(lambda memory: None)
            self.callbacks.stepFinished = fmi2StepFinishedTYPE(lambda environment, status: None)
            self.fmu.instantiate(callbacks=self.callbacks)

    def log(self, status, message):
        self.messages.append((status, message.decode()))

    def set(self, **values):
        names = [name.replace("__", ".") for name in values]
        numbers = [self.references[name] for name in names]
        (self.fmu.setFloat64 if self.is_3 else self.fmu.setReal)(numbers, list(values.values()))

    def get(self, *names):
        numbers = [self.references[name] for name in names]
        return (self.fmu.getFloat64 if self.is_3 else self.fmu.getReal)(numbers)

    def enter(self, tolerance=1e-9):
        if self.is_3:
            self.fmu.enterInitializationMode(tolerance=tolerance, startTime=0.0)
        else:
            self.fmu.setupExperiment(tolerance=tolerance, startTime=0.0)
            self.fmu.enterInitializationMode()

    def start(self, tolerance=1e-9):
        self.enter(tolerance)
        self.fmu.exitInitializationMode()

    def step(self, time, step):
        self.fmu.doStep(currentCommunicationPoint=time, communicationStepSize=step)

    def fails(self, status, words, call):
        """Expects that a call returns a status and logs words."""
        before = len(self.messages)
        try:
            call()
        except FMICallException as failure:
            assert failure.status == status, (words, failure.status, self.messages)
            if self.is_3:
                logged = self.messages[before:]
                assert any(of == status and words in message for of, message in logged), (words, logged)
            else:
                assert [of for of, _ in self.messages[before:]] == [status]
            return
        raise AssertionError(f"{words}: the call succeeds")


def pointer(array):
    return array.ctypes.data_as(POINTER(c_double))


def names(kinds, joints):
    return [f"{kind}.{joint}" for kind in kinds for joint in joints]


KR5 = [f"joint{number}" for number in range(1, 7)]
REFERENCE = np.loadtxt(references / "golden_ref_kuka.csv", delimiter=",")[:101]


def error_of_fall(fmu, interface, tolerance):
    """The largest errors of coordinates, velocities and energies of KR5's free fall of a second."""
    output = names("qv", KR5) + ["energy.kinetic", "energy.potential"]
    result = simulate_fmu(str(fmu), fmi_type=interface, stop_time=1.0, output_interval=0.01,
                          relative_tolerance=tolerance, output=output)
    assert np.allclose(result["time"], REFERENCE[:, 0], atol=1e-12)
    found = np.column_stack([result[name] for name in output])
    difference = np.abs(found - np.delete(REFERENCE, [0, 13], axis=1))
    return [difference[:, part].max() for part in (slice(0, 6), slice(6, 12), slice(12, 14))]


def kr5_falls_to_the_reference():
    for name in ["kr5", "kr5_fmi2"]:
        fmu = made / f"{name}.fmu"
        for interface in INTERFACES:
            loose, tight = (error_of_fall(fmu, interface, tolerance) for tolerance in (1e-6, 1e-9))
            print(name, interface, loose, tight)
            if interface == "CoSimulation":
                # A tolerance is for one step; errors grow by a factor of some ten in this fall, and velocities are ten
                # times the coordinates.
                assert loose[0] < 1e-4 and loose[1] < 1e-3 and loose[2] < 1e-4
                assert tight[0] < 1e-7 and tight[1] < 1e-6 and tight[2] < 1e-7
            else:
                # The steps are those of fmpy's CVODE, which loses more digits.
                assert loose[0] < 1e-3 and tight[0] < 1e-5 and tight[1] < 1e-4 and tight[2] < 1e-5
            # And so the errors are those of integration, not of the equations.
            assert all(few < many / 30 for few, many in zip(tight, loose))


def derivatives_are_those_of_the_reference():
    """The classical method of order 4 over the functions of model exchange: its error is its own, about 16 times less at
    half the step."""
    for name in ["kr5", "kr5_fmi2"]:
        errors = []
        for steps in (500, 1000):
            instance = Instance(made / f"{name}.fmu", "ModelExchange")
            instance.start()
            fmu = instance.fmu
            fmu.enterContinuousTimeMode()
            y, k, h = np.zeros(12), np.zeros(12), 1.0 / steps

            def rate(time, state):
                state = np.ascontiguousarray(state)
                fmu.setTime(time)
                fmu.setContinuousStates(pointer(state), 12)
                derivative = fmu.getContinuousStateDerivatives if instance.is_3 else fmu.getDerivatives
                derivative(pointer(k), 12)
                return k.copy()

            for step in range(steps):
                t = step * h
                k1 = rate(t, y)
                k2 = rate(t + h / 2, y + h / 2 * k1)
                k3 = rate(t + h / 2, y + h / 2 * k2)
                k4 = rate(t + h, y + h * k3)
                y = y + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
            errors.append(np.abs(y - REFERENCE[100, 1:13]).max())
        print(name, "order 4:", errors)
        assert errors[1] < 1e-6 and 8 < errors[0] / errors[1] < 32


def a_free_base_keeps_energy_and_its_quaternion():
    """Both interfaces agree, though each integrates otherwise."""
    fmu = made / "floating.fmu"
    description = read_model_description(str(fmu))
    states = [variable.name for variable in description.modelVariables if variable.name.startswith(("q.", "v."))]
    velocities = [name for name in states if name.startswith("v.")]
    start = {name: 0.3 * (-1) ** place for place, name in enumerate(velocities)}
    ends = []
    for interface in INTERFACES:
        output = states + ["energy.kinetic", "energy.potential"]
        result = simulate_fmu(str(fmu), fmi_type=interface, stop_time=1.0, output_interval=0.1,
                              relative_tolerance=1e-10, start_values=start, output=output)
        energy = result["energy.kinetic"] + result["energy.potential"]
        assert np.ptp(result["energy.kinetic"]) > 1.0
        assert np.ptp(energy) < 1e-6 * np.ptp(result["energy.kinetic"]), np.ptp(energy)
        quaternion = np.column_stack([result[name] for name in states if ".q" in name[1:]])
        assert quaternion.shape[1] == 4 and np.abs(np.linalg.norm(quaternion, axis=1) - 1).max() < 1e-7
        ends.append([result[name][-1] for name in states])
    assert np.abs(np.subtract(*ends)).max() < 1e-5, np.abs(np.subtract(*ends)).max()


def parameters_and_inputs_act():
    """Without gravity nothing accelerates but by the joint forces, M a = tau: as much as the force, linearly."""
    for name in ["given", "given_fmi2"]:
        instance = Instance(made / f"{name}.fmu", "CoSimulation")
        joints = [f"joint{number}" for number in range(1, 5)]
        instance.set(parameters__gravity__y=0.0, parameters__joint2__damping=0.0)
        instance.enter()
        assert instance.get(*names("a", joints)) == [0.0] * 4
        instance.set(tau__joint1=1.0)
        once = np.array(instance.get(*names("a", joints)))
        instance.set(tau__joint1=2.0)
        twice = np.array(instance.get(*names("a", joints)))
        assert abs(once[0]) > 1.0 and np.abs(twice - 2 * once).max() < 1e-12 * np.abs(once).max()
        # The symmetry of M⁻¹: a1 by tau2 is a2 by tau1.
        instance.set(tau__joint1=0.0, tau__joint2=1.0)
        (other,) = instance.get("a.joint1")
        assert abs(other - once[1]) < 1e-12 * abs(once[1])
        # The work of a constant force is the kinetic energy.
        instance.set(tau__joint1=0.1, tau__joint2=0.0)
        instance.fmu.exitInitializationMode()
        instance.step(0.0, 0.2)
        turned, energy = instance.get("q.joint1", "energy.kinetic")
        assert energy > 1e-3 and abs(energy - 0.1 * turned) < 1e-8, (energy, turned)


def a_state_is_taken_up_again():
    for name in ["kr5", "kr5_fmi2"]:
        instance = Instance(made / f"{name}.fmu", "CoSimulation")
        instance.start()
        instance.step(0.0, 0.3)
        get, put, free, pack, unpack = (
            (instance.fmu.getFMUState, instance.fmu.setFMUState, instance.fmu.freeFMUState,
             instance.fmu.serializeFMUState, instance.fmu.deserializeFMUState) if instance.is_3 else
            (instance.fmu.getFMUstate, instance.fmu.setFMUstate, instance.fmu.freeFMUstate,
             instance.fmu.serializeFMUstate, instance.fmu.deSerializeFMUstate))
        state = get()
        packed = pack(state)
        instance.step(0.3, 0.4)
        end = instance.get(*names("qva", KR5))
        for again in (state, unpack(packed)):
            put(again)
            instance.step(0.3, 0.4)
            assert instance.get(*names("qva", KR5)) == end
            free(again)


def faults_are_logged():
    nan = float("nan")
    for name in ["given", "given_fmi2"]:
        fmu = made / f"{name}.fmu"
        instance = Instance(fmu, "CoSimulation")
        instance.fails(ERROR, "tau.joint1 must be a finite number, not nan", lambda: instance.set(tau__joint1=nan))
        instance.fails(ERROR, "a.joint1 is computed and cannot be set", lambda: instance.set(a__joint1=1.0))
        instance.fails(ERROR, "DoStep is called while the instance is instantiated", lambda: instance.step(0.0, 0.1))
        instance.set(parameters__link3__mass=-1.0)
        instance.enter()
        instance.fails(ERROR, "parameters.link3.mass is -1 and must be a finite number that is not negative",
                       instance.fmu.exitInitializationMode)

        instance = Instance(fmu, "CoSimulation")
        instance.start()
        instance.fails(ERROR, "q.joint1 can be set until the initialization ends", lambda: instance.set(q__joint1=1.0))
        instance.fails(ERROR, "parameters.link3.mass can be set until",
                       lambda: instance.set(parameters__link3__mass=1.0))
        instance.fails(ERROR, "cannot follow 0 s", lambda: instance.step(0.5, 0.1))
        instance.step(0.0, 0.1)
        # A force that accelerates beyond what numbers can hold: the step stops where it is, and reports it.
        instance.set(tau__joint1=1e160)
        instance.fails(DISCARD, "the integration stops at 0.1", lambda: instance.step(0.1, 0.1))
        instance.set(tau__joint1=0.0)

        instance = Instance(fmu, "ModelExchange")
        instance.start()
        instance.fmu.enterContinuousTimeMode()
        states = np.full(8, nan)
        instance.fails(DISCARD, "q.joint1 must be a finite number, not nan",
                       lambda: instance.fmu.setContinuousStates(pointer(states), 8))


def sources_compile_elsewhere():
    fmu = made / "sources" / "kr5.fmu"
    assert not any(name.startswith("binaries/") for name in zipfile.ZipFile(fmu).namelist())
    assert validate_fmu(str(fmu)) == []
    folder = extract(str(fmu))
    build_platform_binary(folder)
    error, *_ = error_of_fall(folder, "CoSimulation", 1e-9)
    assert error < 1e-7


def units_are_defined_and_dependencies_exact():
    description = read_model_description(str(made / "kr5.fmu"))
    units = {variable.name: variable.unit for variable in description.modelVariables}
    assert [units[f"{kind}.joint1"] for kind in ("q", "v", "a", "tau")] == ["rad", "rad/s", "rad/s2", "N.m"]
    assert units["parameters.gravity.z"] == "m/s2" and units["energy.kinetic"] == "J"
    on = {output.variable.name: {variable.name for variable in output.dependencies} for output in description.outputs}
    # Turning the whole arm changes its potential energy, if gravity has another direction, but not the kinetic one.
    assert on["energy.kinetic"] == set(names("q", KR5[1:]) + names("v", KR5)), on["energy.kinetic"]
    assert on["energy.potential"] == set(names("q", KR5[:5])), on["energy.potential"]
    assert on["a.joint1"] == set(names(["q", "v", "tau"], KR5)), on["a.joint1"]
    rates = {rate.variable.name: [variable.name for variable in rate.dependencies] for rate in description.derivatives}
    assert rates["der(q.joint3)"] == ["v.joint3"]


for path in sorted(made.glob("*.fmu")):
    problems = validate_fmu(str(path))
    assert problems == [], (path, problems)
for test in (kr5_falls_to_the_reference, derivatives_are_those_of_the_reference,
             a_free_base_keeps_energy_and_its_quaternion, parameters_and_inputs_act, a_state_is_taken_up_again,
             faults_are_logged, sources_compile_elsewhere, units_are_defined_and_dependencies_exact):
    test()
    print(f"{test.__name__}: as expected")
