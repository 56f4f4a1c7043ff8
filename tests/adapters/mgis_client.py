"""A host of MFront's generic interface: it reads a behaviour of a library by its symbols, in the order and with the
fallbacks of MGIS, and calls it for one material point. Nothing here knows rvelab."""
from __future__ import annotations

import ctypes
from ctypes import POINTER, Structure, c_char_p, c_double, c_int, c_ushort

import numpy as np

# Components of scalars, symmetric tensors and tensors by hypothesis.
SIZES = {"PlaneStrain": {0: 1, 1: 4, 3: 5}, "Axisymmetrical": {0: 1, 1: 4, 3: 5}, "Tridimensional": {0: 1, 1: 6, 3: 9}}
SYMMETRIC = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]
ALL = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 0), (0, 2), (2, 0), (1, 2), (2, 1)]
PREDICTION, NO_TANGENT, CONSISTENT_TANGENT, AND_SPEED = -3, 0, 4, 100


def symmetric(tensor: np.ndarray, n: int) -> np.ndarray:
    mean = (tensor + tensor.T) / 2
    return np.array([mean[i, j] * (1 if i == j else np.sqrt(2)) for i, j in SYMMETRIC[:n]])


def matrix(components: np.ndarray) -> np.ndarray:
    """Of 4 or 6 symmetric components, or of 5 or 9."""
    tensor = np.zeros((3, 3))
    if len(components) in (4, 6):
        for value, (i, j) in zip(components, SYMMETRIC):
            tensor[i, j] = tensor[j, i] = value / (1 if i == j else np.sqrt(2))
    else:
        for value, (i, j) in zip(components, ALL):
            tensor[i, j] = value
    return tensor


class State(Structure):
    _fields_ = [(name, POINTER(c_double)) for name in (
        "gradients", "thermodynamic_forces", "mass_density", "material_properties", "internal_state_variables",
        "stored_energy", "dissipated_energy", "external_state_variables")]


class Data(Structure):
    _fields_ = [("error_message", c_char_p), ("dt", c_double), ("K", POINTER(c_double)), ("rdt", POINTER(c_double)),
                ("speed_of_sound", POINTER(c_double)), ("s0", State), ("s1", State)]


class Behaviour:
    def __init__(self, library: str, name: str, hypothesis: str, measure: int = 0, tangent: int = 0) -> None:
        """measure and tangent: what MGIS calls the options of finite strain."""
        self._library, self.name, self.hypothesis = ctypes.CDLL(library), name, hypothesis
        if self._number("mfront_mkt") != 1 or self._number("api_version") != 1:
            raise ValueError(f"{name} is no behaviour of version 1")
        self.interface = self._text("mfront_interface")
        self.kind, self.kinematic = self._number("BehaviourType"), self._number("BehaviourKinematic")
        self.gradients, self.gradient_types = self._variables("Gradients")
        self.forces, self.force_types = self._variables("ThermodynamicForces")
        if (self.kind, self.kinematic) not in ((1, 1), (2, 3)) or len(self.gradients) != 1 or self.forces != ["Stress"]:
            raise ValueError(f"{name} is of another kind")
        self.orthotropic = self._number("SymmetryType") != 0
        if self._number("requiresStiffnessTensor") or self._number("requiresThermalExpansionCoefficientTensor"):
            raise ValueError(f"{name} wants elastic constants")
        self.properties = self._texts("MaterialProperties")
        self.states, self.state_types = self._variables("InternalStateVariables")
        self.external, _ = self._variables("ExternalStateVariables")
        if self._number("TemperatureRemovedFromExternalStateVariables"):
            self.external = ["Temperature", *self.external]
        self.parameters, _ = self._variables("Parameters")
        self.blocks = self._texts("TangentOperatorBlocks")
        self.energies = self._number("ComputesInternalEnergy") + self._number("ComputesDissipatedEnergy")
        self.functions = self._texts("InitializeFunctions") + self._texts("PostProcessings")
        self.measure, self.tangent = measure, tangent
        sizes = SIZES[hypothesis]
        self.symmetric, self.all = sizes[1], sizes[3]
        self.gradient_size = sizes[self.gradient_types[0]]
        self.force_size = sizes[3] if self.kind == 2 and measure == 2 else sizes[1]
        rows, columns = {0: (1, 3), 1: (1, 1), 2: (3, 3), 3: (1, 3)}[tangent] if self.kind == 2 else (1, 1)
        self.tangent_shape = sizes[rows], sizes[columns]
        self.integrate = getattr(self._library, f"{name}_{hypothesis}")
        self.integrate.argtypes, self.integrate.restype = [POINTER(Data)], c_int

    def _symbol(self, name: str, kind: type) -> object:
        for symbol in (f"{self.name}_{self.hypothesis}_{name}", f"{self.name}_{name}"):
            try:
                return kind.in_dll(self._library, symbol)
            except ValueError:
                continue
        raise ValueError(f"{self.name} has no {name}")

    def _number(self, name: str) -> int:
        return self._symbol(name, c_ushort).value

    def _text(self, name: str) -> str:
        return self._symbol(name, c_char_p).value.decode()

    def _texts(self, name: str) -> list[str]:
        n = self._number("n" + name)
        return [text.decode() for text in self._symbol(name, c_char_p * n)] if n else []

    def _variables(self, name: str) -> tuple[list[str], list[int]]:
        names = self._texts(name)
        types = self._symbol(name + "Types", c_int * max(len(names), 1))
        return names, list(types)[:len(names)]


class Point:
    """One material point: states at the start (s0) and the end (s1) of a step, as arrays by MGIS's names."""

    def __init__(self, behaviour: Behaviour, stress: np.ndarray, properties: list[float], density: float = 0) -> None:
        """stress: Cauchy; the deformation is none, so that it is each other measure too."""
        self.behaviour = behaviour
        n = behaviour.gradient_size
        forces = (np.array([stress[i, j] for i, j in ALL[:behaviour.all]]) if behaviour.force_size in (5, 9)
                  else symmetric(stress, behaviour.symmetric))
        start = np.array([1.0, 1, 1] + (n - 3) * [0]) if behaviour.kind == 2 else np.zeros(n)
        self.s0, self.s1 = ({"gradients": start.copy(), "thermodynamic_forces": forces.copy(),
                             "mass_density": np.array([float(density)]),
                             "material_properties": np.array(properties, float),
                             "internal_state_variables": np.zeros(len(behaviour.states))} for _ in range(2))
        self.dt, self.rdt, self.speed = 1.0, np.ones(1), np.zeros(1)
        self.K = np.zeros(max(behaviour.tangent_shape[0] * behaviour.tangent_shape[1], 3))
        self._message = ctypes.create_string_buffer(512)

    def call(self, wanted: float = CONSISTENT_TANGENT, **missing: bool) -> int:
        """K=False: a null pointer."""
        self.K[:3] = wanted, self.behaviour.measure, self.behaviour.tangent
        self._message.value, self.rdt[0] = b"", 1

        def pointer(array: np.ndarray) -> object:
            return array.ctypes.data_as(POINTER(c_double))

        states = [State(**{name: pointer(array) for name, array in state.items()}) for state in (self.s0, self.s1)]
        data = Data(ctypes.cast(self._message, c_char_p), self.dt, None if "K" in missing else pointer(self.K),
                    pointer(self.rdt), pointer(self.speed), *states)
        return self.behaviour.integrate(data)

    def set(self, gradient: np.ndarray) -> None:
        """F, or the strain, at the end of the step."""
        if self.behaviour.kind == 2:
            self.s1["gradients"][:] = [gradient[i, j] for i, j in ALL[:self.behaviour.all]]
        else:
            self.s1["gradients"][:] = symmetric(gradient, self.behaviour.symmetric)

    def update(self) -> None:
        for name, array in self.s1.items():
            self.s0[name][:] = array

    def revert(self) -> None:
        for name, array in self.s0.items():
            self.s1[name][:] = array

    @property
    def stress(self) -> np.ndarray:
        return matrix(self.s1["thermodynamic_forces"])

    @property
    def tangent(self) -> np.ndarray:
        return self.K[:np.prod(self.behaviour.tangent_shape)].reshape(self.behaviour.tangent_shape)

    @property
    def message(self) -> str:
        return self._message.value.decode()
