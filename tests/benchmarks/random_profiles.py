"""Random smooth maneuvers, inside the limits, against CasADi/IPOPT on the same problem.

    python -m tests.benchmarks.random_profiles --count 1000

For each seed: sums of sines on the three joints, the nearest executable motion,
then the whole Coriolis vector minimised inside the machine's limits, scalar and per
joint in turn. IPOPT solves the same discrete problem from the same start (u = 1).
Printed: how many end within 1e-6 of IPOPT's cost or below it, every one that does
not, the largest excess over a limit, and the time of both.
"""

from __future__ import annotations

import argparse
import time

import casadi as ca
import numpy as np

from des_cli.kinematics.chain import chain_of
from des_cli.model.arrays import Floats
from des_cli.model.machine import Seat
from des_cli.model.machines import DES
from des_cli.model.motion import Motion
from des_cli.reduction.executable import nearest_executable
from des_cli.reduction.limits import measure_peaks
from des_cli.reduction.optimum import find_optimum
from des_cli.reduction.problem import Problem
from des_cli.reduction.search import Search

SAMPLES = 121
DURATION_S = 12.0
R1, TRACKING = 2.0, 0.1
R2 = {1: 0.5, 3: 0.5}
AGREE = 1e-6


def random_motion(seed: int) -> Motion:
    """Return a smooth random motion of the three joints."""
    generator = np.random.default_rng(seed)
    t = np.linspace(0.0, DURATION_S, SAMPLES)
    angle, rate = np.zeros((SAMPLES, 3)), np.zeros((SAMPLES, 3))
    for joint, (rise, speed) in enumerate(((0.25, 1.5), (0.8, 0.0), (0.8, 0.0))):
        rate[:, joint] += speed * generator.uniform(0.2, 1.0)
        angle[:, joint] += rate[0, joint] * t + generator.uniform(-0.5, 0.5)
        for wave in range(1, 4):
            w = 2.0 * np.pi * wave / DURATION_S * generator.uniform(0.7, 1.3)
            phase = generator.uniform(0.0, 2.0 * np.pi)
            size = rise * generator.normal() / wave**1.5
            angle[:, joint] += size * np.sin(w * t + phase)
            rate[:, joint] += size * w * np.cos(w * t + phase)
    return Motion(t, angle, rate[:-1], rate[1:])


class Peer:
    """IPOPT on the same discrete problem, written with the study's closed forms."""

    def __init__(self, controls: int) -> None:
        n, m = SAMPLES, controls
        self.controls = m
        step = DURATION_S / (n - 1)
        weight = np.full(n, step)
        weight[[0, -1]] *= 0.5
        u, theta = ca.SX.sym("u", m, n), ca.SX.sym("theta", 3, n)
        phi, wanted = ca.SX.sym("phi", 3, n), ca.SX.sym("wanted", 3, n)
        rate = (ca.repmat(u, 3, 1) if m == 1 else u) * phi
        s1, c1 = ca.sin(theta[0, :]), ca.cos(theta[0, :])
        s2, c2 = ca.sin(theta[1, :]), ca.cos(theta[1, :])
        v1, v2, v3 = rate[0, :], rate[1, :], rate[2, :]
        ab3 = -v2 * v1 * s1 - v3 * v1 * c1 * c2 + v3 * v2 * s1 * s2  # (22)
        bb3 = -v2 * v1 * c1 + v3 * v1 * s1 * c2 + v3 * v2 * c1 * s2  # (23)
        cb3 = -v3 * v2 * c2  # (24)
        running = R1 * (ab3**2 + bb3**2 + cb3**2)
        running += R2[m] / m * ca.sum1((1 - u) ** 2)
        running += TRACKING * ca.sum1((theta - wanted) ** 2)
        cost = 0.5 * ca.mtimes(running, weight)
        moved = theta[:, 1:] - theta[:, :-1] - 0.5 * step * (rate[:, 1:] + rate[:, :-1])
        constraints = ca.vertcat(
            ca.vec(moved),
            ca.vec(rate),
            ca.vec((rate[:, 1:] - rate[:, :-1]) / step),
            ca.vec(theta[1:, :]),
        )
        limit = np.array([[j.angle, j.rate, j.acceleration] for j in DES.limits])
        bound = np.concatenate(
            [
                np.zeros(3 * (n - 1)),
                np.tile(limit[:, 1], n),
                np.tile(limit[:, 2], n - 1),
                np.tile(limit[1:, 0], n),
            ]
        )
        self.bounds = (-bound, bound)
        x = ca.vertcat(ca.vec(u), ca.vec(theta))
        parameters = ca.vertcat(ca.vec(phi), ca.vec(wanted))
        options = {"ipopt.print_level": 0, "print_time": 0, "ipopt.tol": 1e-9, "ipopt.sb": "yes"}
        self.solver = ca.nlpsol(
            "peer", "ipopt", {"x": x, "p": parameters, "f": cost, "g": constraints}, options
        )

    def solve(self, motion: Motion) -> tuple[bool, float]:
        """Return whether IPOPT converged, and its cost."""
        m = self.controls
        phi = np.vstack([motion.rate_start, motion.rate_end[-1:]])
        start = np.concatenate([np.ones(m * SAMPLES), motion.angle.ravel()])
        low = np.full(start.shape, -np.inf)
        high = -low
        first = slice(m * SAMPLES, m * SAMPLES + 3)
        low[first] = high[first] = motion.angle[0]
        result = self.solver(
            x0=start,
            p=np.concatenate([phi.ravel(), motion.angle.ravel()]),
            lbx=low,
            ubx=high,
            lbg=self.bounds[0],
            ubg=self.bounds[1],
        )
        return bool(self.solver.stats()["success"]), float(result["f"])


def excess_over_limits(motion: Motion) -> float:
    """Return the largest relative excess of a motion over the machine's limits."""
    peaks = measure_peaks(motion)
    limit = np.array([[j.angle, j.rate, j.acceleration] for j in DES.limits]).T
    measured: Floats = np.stack([peaks.angle, peaks.rate, peaks.acceleration])
    return float(np.max(measured / limit) - 1.0)


def main() -> None:
    """Compare and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--first", type=int, default=0, help="first seed")
    options = parser.parse_args()
    peers = {m: Peer(m) for m in (1, 3)}
    good = below = failed = peer_failed = 0
    worst, ours_s, peer_s = -np.inf, 0.0, 0.0
    for seed in range(options.first, options.first + options.count):
        m = 1 if seed % 2 else 3
        motion, _ = nearest_executable(DES, random_motion(seed))
        problem = Problem(
            desired=motion,
            chain=chain_of(DES, Seat()),
            axes="seat",
            r1=R1 * np.eye(3),
            r2=np.full(m, R2[m] / m),
            tracking=np.full(3, TRACKING),
            machine=DES,
        )
        begun = time.perf_counter()
        solution = find_optimum(problem, Search(3000))
        ours_s += time.perf_counter() - begun
        begun = time.perf_counter()
        success, cost = peers[m].solve(motion)
        peer_s += time.perf_counter() - begun
        worst = max(worst, excess_over_limits(solution.modified))
        failed += not solution.converged
        peer_failed += not success
        difference = (solution.cost - cost) / max(abs(cost), 1e-12)
        agrees = solution.converged and (difference <= AGREE or not success)
        good += agrees
        below += agrees and difference < -AGREE
        if not agrees:
            print(
                f"seed {seed:5d} m = {m}: {solution.status}, {solution.cost:.9f} against "
                f"IPOPT's {cost:.9f} ({difference:+.2e})",
                flush=True,
            )
    print(
        f"{options.count} profiles: {good} within {AGREE:g} of IPOPT's cost or below it "
        f"({below} below), {failed} of ours and {peer_failed} of IPOPT's not converged; "
        f"largest excess over a limit {worst:.1e}; {ours_s:.1f} s against {peer_s:.1f} s"
    )


if __name__ == "__main__":
    main()
