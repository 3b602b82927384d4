"""The Python interface: one maneuver reduced, as a notebook or a script wants it.

It puts together what the command line does too: reading, `pipeline.reduce_profile`, the last
check of a table, files and figures.
"""
