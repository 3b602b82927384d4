"""Two points of a curve, as data: an optimum, and one that was not found."""

from des_cli.model.tradeoff import TradePoint

POINT = TradePoint(
    "optimum",
    "scalar",
    "joint_deviation_relative",
    0.05,
    "converged",
    **{f"{part}_reduction": 0.5 for part in ("objective", "bb3", "vector")},
    seat_x_reduction=-0.25,
    seat_y_reduction=0.5,
    seat_z_reduction=0.5,
    joint_deviation_relative=0.0499,
    seat_rate_deviation_relative=0.2,
    seat_g_rms_error_g=0.3,
    seat_angular_acceleration_rms_error_rad_s2=0.143,
    seat_angular_acceleration_rms_before_rad_s2=0.462,
    seat_angular_acceleration_rms_rad_s2=0.447,
    seat_angular_acceleration_peak_before_rad_s2=0.539,
    seat_angular_acceleration_peak_rad_s2=0.561,
    attitude_error_max_deg=20.0,
    cost=0.1,
    iterations=7,
    limits_ok=True,
)

GONE = TradePoint("optimum", "scalar", "r2", 1.0, "iteration-limit", message="too few steps")
