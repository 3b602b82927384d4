"""The independent check of a solution, from the motion alone.

No code is shared with what finds a solution: nothing of ``kinematics``, ``study`` and
``solver``, nor of the methods in ``reduction``. What is shared, so that an error in it
would pass unseen:

``model``
    What things are: the profile, the machine with its Denavit-Hartenberg rows and limits,
    the solution. They are data; of `Motion` also its own arithmetic, the steps of time,
    the acceleration of an interval and the jerk at a sample.
``units``
    Standard gravity.
``reduction.problem.Problem``
    As data, of factors on the desired rates: the desired motion, weights, axes, ends,
    held joints and limits. Its chain is not used. That the problem was posed as the profile says is
    not checked; costs, dynamics and first-order conditions are, for the problem as posed.
The motion that is asked for
    Angles and rates of the joints as ``kinematics`` found them from the profile, and the
    ``Shortfall``, what they do not make of it. Recorded rates and a requested G are
    compared with as they are in the profile.

``tests/verify/test_felt.py`` keeps the imports.
"""
