"""From a desired motion to the nearest one with less Coriolis, and its verification."""
