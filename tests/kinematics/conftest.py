"""Machines, states and comparisons that the kinematics are tested with."""

from support.states import case, rng, same, state, step  # noqa: F401 (fixtures)
