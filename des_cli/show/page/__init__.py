"""Runs on one page: ``page`` makes the HTML of runs read back from their folders."""
