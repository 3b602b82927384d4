"""The content of ``metrics.json``, typed: what a reduction gained and what it cost.

A field is called as its key in the file, with its unit. A number that is not known is None:
in a run there are few of these, but the file may be of another version, or a stranger's.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import zip_longest
from typing import Any, Literal, NamedTuple, TypeAlias, get_args

from des_cli.model.coriolis import ComponentKey
from des_cli.model.felt import BeforeAfter, Felt, TurningSizes
from des_cli.model.loads import Loads
from des_cli.model.machine import JOINTS, Joint
from des_cli.model.metric import JOINT_DEVIATION, MetricKey
from des_cli.model.notice import Notice
from des_cli.model.sections import INLINED, LEFT_OUT, as_mapping, keyed

When: TypeAlias = Literal["start", "end"]


@dataclass(frozen=True, slots=True)
class ProfileFacts:
    """Which profile it was."""

    name: str | None = None
    sha256: str | None = None
    samples: int | None = None
    duration_s: float | None = None
    machine: str | None = None


@dataclass(frozen=True, slots=True)
class SolverFacts:
    """What was to be solved, and how that ended; ``cost`` is J."""

    method: str | None = None
    algorithm: str | None = None
    control: str | None = None
    axes: str | None = None
    jacobian: str | None = None
    r1: tuple[tuple[float | None, ...], ...] | None = None
    r2: tuple[float | None, ...] | None = None
    tracking: tuple[float | None, ...] | None = None
    limits: str | None = None
    ends: str | None = None
    objective: str | None = None
    optimise: tuple[str, ...] = ()
    budget: Mapping[str, float] | None = None
    allow_change: float | None = None
    status: str | None = None
    converged: bool | None = None
    iterations: int | None = None
    cost: float | None = None
    cost_unreduced: float | None = None
    optimality: float | None = None
    message: str | None = None


@dataclass(frozen=True, slots=True)
class Constant:
    """A constant that was found together with the motion."""

    before_deg: float | None = None
    after_deg: float | None = None

    @property
    def angle(self) -> BeforeAfter:
        """Its value [deg]."""
        return BeforeAfter(self.before_deg, self.after_deg)


@dataclass(frozen=True, slots=True)
class AskedG:
    """How far the machine's own motion is from an asked G, and from the rates beside it."""

    rms_g: float | None = None
    largest_g: float | None = None
    largest_at_s: float | None = None
    onset_asked_g_s: float | None = None
    onset_made_g_s: float | None = None
    roll_rate_rms_rad_s: float | None = None
    pitch_rate_rms_rad_s: float | None = None


@dataclass(frozen=True, slots=True)
class Part:
    """What became of one part of the cross-coupling vector.

    ``reduction`` is 1 - int after^2 / int before^2, None where there was nothing before.
    """

    reduction: float | None = None
    sizes: TurningSizes = field(default_factory=TurningSizes, metadata=INLINED)


@dataclass(frozen=True, slots=True)
class Objective:
    """The reduction of what is weighed."""

    reduction: float | None = None


@dataclass(frozen=True, slots=True)
class CrossCoupling:
    """All parts of the cross-coupling, and what is weighed of them."""

    parts: Mapping[ComponentKey, Part] = field(
        default_factory=lambda: {key: Part() for key in get_args(ComponentKey)}, metadata=INLINED
    )
    objective: Objective = field(default_factory=Objective)

    def reduction(self, key: ComponentKey) -> float | None:
        """Return the reduction of one part."""
        return self.parts[key].reduction


class Offset(NamedTuple):
    """By how much the joints are off the profile: angles [rad] and rates [rad/s]."""

    angle: Mapping[Joint, float | None]
    rate: Mapping[Joint, float | None]


@dataclass(frozen=True, slots=True)
class Fidelity:
    """The metrics by their keys, and how far joints and tilt are off."""

    metrics: Mapping[str, float | None] = field(default_factory=dict, metadata=INLINED)
    joint_rms_rad: Mapping[Joint, float | None] = field(default_factory=dict)
    start_error: Mapping[str, float | None] = field(default_factory=dict)
    end_error_rad: Mapping[Joint, float | None] = field(default_factory=dict)
    end_error_rad_s: Mapping[Joint, float | None] = field(default_factory=dict)
    tilt_error_max_deg: float | None = None
    tilt_error_rms_deg: float | None = None

    def value(self, metric: MetricKey) -> float | None:
        """Return a metric, in its unit."""
        return self.metrics.get(metric)

    def offset(self, when: When) -> Offset:
        """Return by how much the joints are off at an end of the maneuver."""
        if when == "end":
            return Offset(self.end_error_rad, self.end_error_rad_s)
        return Offset(
            {joint: self.start_error.get(f"{joint}_rad") for joint in JOINTS},
            {joint: self.start_error.get(f"{joint}_rad_s") for joint in JOINTS},
        )


@dataclass(frozen=True, slots=True)
class Added:
    """What the reduction adds to a motion that budgets hold round, which is not the record."""

    budgets: Mapping[str, float | None] = field(default_factory=dict)
    felt: Felt = field(default_factory=Felt)


@dataclass(frozen=True, slots=True)
class Change:
    """What one step from the record to the motion that is reduced cost."""

    joint_change_relative: float | None = None
    joint_change_max_rad: Mapping[Joint, float | None] = field(default_factory=dict)
    coriolis_reduction: float | None = None
    metrics: Mapping[str, float | None] = field(default_factory=dict, metadata=INLINED)

    def value(self, metric: MetricKey) -> float | None:
        """Return a metric of the change, in its unit."""
        return self.metrics.get(metric)


@dataclass(frozen=True, slots=True)
class Changes:
    """The steps before the limits, None where a step was not taken.

    ``damping`` are rates held at a limit, or damped near the singularity; ``machine`` is
    what of an asked G it cannot make.
    """

    damping: Change | None = None
    machine: Change | None = None
    smoothing: Change | None = None


@dataclass(frozen=True, slots=True)
class Executable:
    """What keeping the limits alone cost."""

    replaced: bool | None = None
    breaks_limits: bool | None = None
    change: Change = field(default_factory=Change, metadata=INLINED)


@dataclass(frozen=True, slots=True)
class SweepBaseline:
    """What the study's sweep gets from the same profile; nothing where it runs away."""

    reduction: float | None = None
    joint_deviation: float | None = field(default=None, metadata=keyed(JOINT_DEVIATION))


@dataclass(frozen=True, slots=True)
class ConstantBaseline:
    """The constant factor with the same reduction, and its price."""

    p: float | None = None
    joint_deviation: float | None = field(default=None, metadata=keyed(JOINT_DEVIATION))


@dataclass(frozen=True, slots=True)
class BaselineFacts:
    """What simpler means get."""

    report_sweep: SweepBaseline | None = None
    constant_p: ConstantBaseline | None = None


@dataclass(frozen=True, slots=True)
class Singularity:
    """How near the motion that the profile asks for comes to the singularity."""

    min_abs_cos_fork: float | None = None
    min_singular_value: float | None = None
    damped_samples: int | None = None
    max_residual_rad_s: float | None = None
    integration_error_max_deg: float | None = None
    recorded_attitude_error_max_deg: float | None = field(default=None, metadata=LEFT_OUT)


@dataclass(frozen=True, slots=True)
class Metrics:
    """All that a run is measured by, and what is said of it, in the order of the file."""

    profile: ProfileFacts = field(default_factory=ProfileFacts)
    solver: SolverFacts = field(default_factory=SolverFacts)
    parameters: Mapping[str, Constant] | None = None
    asked_g: AskedG | None = None
    coriolis: CrossCoupling = field(default_factory=CrossCoupling)
    fidelity: Fidelity = field(default_factory=Fidelity)
    added: Added | None = None
    felt: Felt = field(default_factory=Felt)
    changes: Changes = field(default_factory=Changes)
    executable: Executable = field(default_factory=Executable)
    baseline: BaselineFacts = field(default_factory=BaselineFacts)
    limits: Loads = field(default_factory=Loads)
    singularity: Singularity = field(default_factory=Singularity)
    violations: tuple[str, ...] = ()
    notices: tuple[str, ...] = ()
    notice_names: tuple[str, ...] = ()

    @property
    def ride(self) -> Felt:
        """What is felt, beside the ride that was reduced: the noise of a record is no ride."""
        return self.added.felt if self.added else self.felt

    @property
    def named_notices(self) -> tuple[Notice, ...]:
        """The notices with their names, as far as these are known."""
        pairs = zip_longest(self.notice_names[: len(self.notices)], self.notices, fillvalue="")
        return tuple(Notice(name, text) for name, text in pairs)

    def mapping(self) -> dict[str, Any]:
        """Return the content of ``metrics.json``, a new one each time."""
        return as_mapping(self)
