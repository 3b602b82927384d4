"""Numerical methods that know no centrifuge: splines, banded systems, interior points."""
