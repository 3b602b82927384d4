"""What a reduction cannot ask for at the same time is refused, each with a sentence."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from des_cli.errors import UsageError
from des_cli.model.metric import Budget
from des_cli.model.profile import Reduction
from des_cli.reduction.consistency import require_consistent

FREE = Reduction()
STUDY = Reduction(control="scalar", ends="free", budget=())
SWEEP = replace(STUDY, algorithm="report-sweep", limits="warn")
ZERO = replace(STUDY, method="zero", control="per-joint")


@pytest.mark.parametrize(
    "reduction",
    [
        FREE,
        STUDY,
        SWEEP,
        ZERO,
        replace(FREE, control="per-joint", ends="match-both"),
        replace(FREE, control="scalar"),
        replace(FREE, objective="felt", optimise=("seat_yaw",), ends="match-rates"),
        replace(FREE, hold=frozenset({"arm", "cab"})),
        replace(FREE, limits="check", lead_in=2.0, lead_out=1.0),
        replace(STUDY, limits="warn", lead_in=2.0),
    ],
)
def test_what_goes_together(reduction: Reduction) -> None:
    require_consistent(reduction)


@pytest.mark.parametrize(
    ("reduction", "words"),
    [
        (replace(FREE, budget=()), "r2 and tracking weigh factors"),
        (replace(FREE, jacobian="adapted"), "jacobian: adapted turns factors"),
        (
            replace(FREE, budget=(Budget("mean_square_one_minus_p", 0.1),)),
            "mean_square_one_minus_p measures factors",
        ),
        (replace(FREE, hold=frozenset({"arm", "fork", "cab"})), "hold leaves no joint"),
        (replace(FREE, r1=np.zeros((3, 3))), "r1 weighs no Coriolis component"),
        (replace(STUDY, hold=frozenset({"arm"})), "hold needs control: per-joint (or free)"),
        (replace(STUDY, objective="blend"), "objective: blend needs control: free"),
        (replace(STUDY, optimise=("cab_start",)), "optimise needs control: free"),
        (replace(STUDY, ends="match-rates"), "match-rates needs control: free; scalar has"),
        (
            replace(FREE, control="per-joint", ends="match-rates"),
            "match-rates needs control: free; per-joint has",
        ),
        (replace(SWEEP, limits="enforce"), "report-sweep cannot enforce limits"),
        (replace(SWEEP, method="zero"), "report-sweep has no method zero"),
        (replace(SWEEP, budget=FREE.budget), "report-sweep needs the weight r2"),
        (replace(SWEEP, jacobian="adapted"), "report-sweep takes the Jacobian"),
        (replace(SWEEP, control="free"), "report-sweep finds factors"),
        (replace(ZERO, budget=FREE.budget), "method zero keeps a tolerance"),
        (replace(ZERO, control="free"), "method zero finds factors"),
    ],
)
def test_one_contradiction_is_one_sentence(reduction: Reduction, words: str) -> None:
    with pytest.raises(UsageError) as caught:
        require_consistent(reduction, "loop")
    (problem,) = caught.value.complaints
    assert problem.where == "loop: reduction"
    assert words in problem.what


def test_all_contradictions_come_at_once() -> None:
    both = replace(STUDY, objective="felt", optimise=("seat_yaw",), ends="match-rates")
    with pytest.raises(UsageError) as caught:
        require_consistent(both)
    assert [problem.where for problem in caught.value.complaints] == ["reduction"] * 3
