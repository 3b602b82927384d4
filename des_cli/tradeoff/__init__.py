"""How much cross-coupling is removed for a given deviation: points, curves and their jobs."""
