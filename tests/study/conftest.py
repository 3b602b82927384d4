"""Machines, states and comparisons that the study's equations are tested with."""

from support.states import case, rng, same, state, step  # noqa: F401 (fixtures)
