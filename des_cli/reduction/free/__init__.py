"""Joints that move freely: a spline of each, inside limits and within felt budgets."""
