# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A flight that keeps its angular momentum: the rotation of a carrier whose parts move relative to
it.

The momentum about the center is L = Q (h + I ω): Q is the rotation of the carrier, h the momentum
and I the inertia of the parts in its axes. So Q follows from an initial value problem, Q' = Q [ω],
with ω = I⁻¹ (Qᵀ L − h). Poses are sampled at `NODES` of every frame and are polynomials between
them; no polynomial crosses a frame, where keys have corners. The integrator is that of Runge, Kutta
and Munthe-Kaas of fourth order, with steps halved until it converges.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..numerics import Array, NDArray, inertia_of_second, quaternion, rotation_matrix
from .motion import Course, angular_velocities, axial_vectors, continuous

# Of a frame, in -1 to 1. A cubic through the first, second, fourth and fifth has the least error of
# its derivative.
PLACES = np.cos(np.pi * np.arange(5)[::-1] / 4.0)
NODES = (PLACES + 1.0) / 2.0
LAST = len(NODES) - 1
_FIT = np.linalg.inv(PLACES[:, None] ** np.arange(len(NODES)))
# RATE maps values at the nodes to rates at the nodes, by a frame, which is 2 in PLACES. No place is
# 0, not even the middle one, cos(π/2) = 6e-17, so that the power -1 is finite; its factor is 0.
# MEAN maps them to the mean of the frame: that of u^k over -1 to 1 is 1/(k + 1) for even k, else 0.
RATE = 2.0 * (np.arange(len(NODES)) * PLACES[:, None] ** (np.arange(len(NODES)) - 1.0)) @ _FIT
MEAN = (np.arange(1, len(NODES) + 1) % 2 / np.arange(1.0, len(NODES) + 1)) @ _FIT
CONVERGED = 1e-6  # rad: change of any rotation when the steps are halved
MAX_HALVINGS = 7
SPINLESS = 0.1  # relative to the parts' momenta: a smaller total is compared with theirs


@dataclass(frozen=True, eq=False)
class CarriedParts:
    """The p parts of a body at the nodes of f frames, in the axes of their carrier, about the
    common center.

    The shapes begin with (f, n): n nodes each, the last of one frame being the first of the next.
    axes: (f, n, 3, 3) rotations of the carrier. arms: (f, n, p, 3). spreads, linear: (f, n, p, 3,
    3), as in Course.
    """

    step: float
    masses: Array
    axes: Array
    arms: Array
    spreads: Array
    linear: Array

    @classmethod
    def of_course(cls, course: Course, axes: NDArray) -> CarriedParts:
        """Return the parts of a course at the nodes of f frames, n - 1 a frame and a last one."""
        rows = LAST * np.arange((len(axes) - 1) // LAST)[:, None] + np.arange(len(NODES))
        back = axes.swapaxes(-1, -2)[:, None]
        arms = (back @ (course.centers - course.center[:, None])[..., None])[..., 0]
        spreads = back @ course.spreads @ back.swapaxes(-1, -2)
        values = (axes, arms, spreads, back @ course.linear)
        return cls(course.step, course.masses, *(array[rows] for array in values))

    def rates(self, values: NDArray) -> Array:
        """Return the rates of (f, n, ...) values, by the second."""
        return np.einsum("mn,fn...->fm...", RATE, values) / self.step

    @cached_property
    def own_momenta(self) -> Array:
        """(f, n, p, 3) angular momenta of the parts' motion relative to the carrier."""
        momenta = self.masses[:, None] * np.cross(self.arms, self.rates(self.arms))
        shape = self.linear.copy()
        shape[np.linalg.det(shape) == 0.0] = np.eye(3)  # a bone scaled to nothing has no spread
        return momenta + axial_vectors(
            self.rates(self.linear) @ np.linalg.inv(shape) @ self.spreads
        )

    @cached_property
    def inertia(self) -> Array:
        """(f, n, p, 3, 3) inertia tensors of the parts about the common center."""
        second = self.spreads + np.einsum("p,fnpi,fnpj->fnpij", self.masses, self.arms, self.arms)
        return inertia_of_second(second)

    @cached_property
    def momenta(self) -> Array:
        """(f, n, p, 3) angular momenta of the parts about the common center, in the world."""
        turns = continuous(quaternion(self.axes.reshape(-1, 3, 3))).reshape(*self.axes.shape[:2], 4)
        spin = angular_velocities(turns, self.rates(turns))
        momenta = self.own_momenta + np.einsum("fnpij,fnj->fnpi", self.inertia, spin)
        return np.einsum("fnij,fnpj->fnpi", self.axes, momenta)

    @property
    def first_momentum(self) -> Array:
        """(3,) mean angular momentum of the first frame."""
        return MEAN @ self.momenta[0].sum(axis=1)

    def deviations(self, kept: NDArray) -> Array:
        """Return (f, n) distances of the angular momentum from a constant one, relative to it.

        If it is below a tenth of the parts' momenta, as of a cat that turns in its fall, they are
        relative to these.
        """
        size = float(np.linalg.norm(kept))
        parts = float(np.linalg.norm(self.momenta, axis=-1).sum(axis=-1).max())
        scale = size if size > SPINLESS * parts else max(parts, np.finfo(float).tiny)
        return np.linalg.norm(self.momenta.sum(axis=2) - kept, axis=-1) / scale

    def constant_spin(self, kept: NDArray) -> Array:
        """Return (f, n, 3, 3) rotations of the carrier that keep a (3,) momentum, the first one
        being its own.

        Steps are halved until no rotation changes by more than 1e-6.
        """
        turns = self._integrate(kept, 1)
        change = np.inf
        for halving in range(1, MAX_HALVINGS + 1):
            if change <= CONVERGED:
                break
            before = turns
            turns = self._integrate(kept, 2**halving)
            change = float(np.abs(turns - before).max())
        return turns

    def _integrate(self, kept: NDArray, steps: int) -> Array:
        """Return the (f, n, 3, 3) rotations by this number of steps from node to node."""
        # The ends and middles of the steps between nodes: (m, s, n) weights of the n nodes at s
        # places in m intervals.
        shares = np.arange(2 * steps + 1) / (2.0 * steps)
        places = PLACES[:-1, None] + np.diff(PLACES)[:, None] * shares
        weights = node_weights((places + 1.0) / 2.0)
        own = np.einsum("msn,fni->fmsi", weights, self.own_momenta.sum(axis=2))
        inertia = np.einsum("msn,fnij->fmsij", weights, self.inertia.sum(axis=2))
        # Points on a line have no inertia about it, so that there may be no inverse.
        inverse = np.linalg.pinv(inertia, hermitian=True)
        lengths = self.step * np.diff(NODES) / steps
        turn = self.axes[0, 0]
        turns = np.empty_like(self.axes)
        for frame in range(len(turns)):
            turns[frame, 0] = turn
            for node, length in enumerate(lengths):
                for row in range(0, 2 * steps, 2):
                    step = slice(row, row + 3)  # its start, middle and end
                    body = (inverse[frame, node, step], own[frame, node, step])
                    turn = turn @ rotation(_step_vector(turn, *body, kept, length))
                turns[frame, node + 1] = turn
        return turns


def _step_vector(
    turn: NDArray, inverses: NDArray, momenta: NDArray, kept: NDArray, length: float
) -> Array:
    """Return the (3,) rotation vector, in the carrier's axes, of one step of the integrator.

    inverses, momenta: (3, 3, 3) of the inertia and (3, 3) of the parts' motion, at the start, the
    middle and the end of the step. length: seconds.
    """
    rate = np.zeros(3)
    total = np.zeros(3)
    # The stages of Runge and Kutta: the sample, the share of the step up to it, and the weight in
    # sixths.
    for sample, share, weight in ((0, 0.0, 1.0), (1, 0.5, 2.0), (1, 0.5, 2.0), (2, 1.0, 1.0)):
        vector = share * length * rate
        spin = inverses[sample] @ ((turn @ rotation(vector)).T @ kept - momenta[sample])
        # The rate of a rotation vector, to the order of the integrator.
        bent = np.cross(vector, spin)
        rate = spin + bent / 2.0 + np.cross(vector, bent) / 12.0
        total += weight / 6.0 * rate
    return length * total


def node_weights(shares: NDArray) -> Array:
    """Return the (..., n) weights of values at the nodes that interpolate at shares of a frame."""
    return (2.0 * shares[..., None] - 1.0) ** np.arange(len(NODES)) @ _FIT


def rotation(vector: NDArray) -> Array:
    """Return the (3, 3) rotation by a vector's length about it."""
    half = 0.5 * float(np.linalg.norm(vector))
    return rotation_matrix(np.concatenate([[np.cos(half)], 0.5 * np.sinc(half / np.pi) * vector]))
