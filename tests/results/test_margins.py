"""How much of each limit is used."""

from des_cli.model.loads import JointLoad, Loads
from des_cli.model.metrics import Metrics
from des_cli.results.margins import limit_uses, nearest_limit


def test_a_limit_that_is_not_known_is_none() -> None:
    load = JointLoad(rate_peak_rad_s=1.0, rate_limit_rad_s=4.0, jerk_peak_rad_s3=3.0)
    (use,) = limit_uses({"fork": load})
    assert (use.joint, use.driven, use.share, use.margin, use.ok) == (
        "fork",
        "rate",
        0.25,
        0.75,
        True,
    )
    assert limit_uses({"arm": JointLoad(rate_peak_rad_s=1.0, rate_limit_rad_s=0.0)}) == []


def test_rounding_is_no_violation() -> None:
    limit = {"rate_limit_rad_s": 4.0}
    assert limit_uses({"arm": JointLoad(rate_peak_rad_s=4.0 * (1 + 1e-12), **limit)})[0].ok
    assert not limit_uses({"arm": JointLoad(rate_peak_rad_s=4.001, **limit)})[0].ok


def test_the_nearest_limit_of_both_motions() -> None:
    near = JointLoad(rate_peak_rad_s=3.0, rate_limit_rad_s=4.0)
    far = JointLoad(rate_peak_rad_s=1.0, rate_limit_rad_s=4.0)
    metrics = Metrics(limits=Loads({"arm": far, "cab": near}, {"arm": near, "cab": far}))
    desired, modified = nearest_limit(metrics)
    assert desired is not None
    assert modified is not None
    assert (desired.joint, modified.joint) == ("cab", "arm")
    assert nearest_limit(Metrics()) == (None, None)
