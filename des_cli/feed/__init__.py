"""Rows sent at their times."""
