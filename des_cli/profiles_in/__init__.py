"""Profiles and machines, read from files and checked: all that is wrong, at once."""
