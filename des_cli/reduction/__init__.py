"""From a desired motion to one near it with less cross-coupling."""
