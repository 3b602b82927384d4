"""Oracles and helpers of the tests. Nothing in an oracle comes from ``des_cli``."""
