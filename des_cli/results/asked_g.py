"""How far the machine's own motion is from the G that a profile asks for."""

from __future__ import annotations

from des_cli.model.metrics import AskedG
from des_cli.model.motion import GOffset


def asked_g_metrics(offset: GOffset | None) -> AskedG | None:
    """Return the offset of the desired motion from an asked G, None where none is asked."""
    if offset is None:
        return None
    return AskedG(
        rms_g=offset.rms,
        largest_g=offset.largest,
        largest_at_s=offset.largest_at,
        onset_asked_g_s=offset.onset_asked,
        onset_made_g_s=offset.onset_made,
        roll_rate_rms_rad_s=offset.roll_rate_rms,
        pitch_rate_rms_rad_s=offset.pitch_rate_rms,
    )


def asked_g_sentence(offset: GOffset | None) -> str:
    """Say the same in a sentence, empty where no G is asked."""
    if offset is None:
        return ""
    words = (
        f"the machine makes the G that is asked to {offset.rms:.3g} g rms and {offset.largest:.3g} "
        f"g at most, at t = {offset.largest_at:g} s; the largest onset of |G| is "
        f"{offset.onset_made:.3g} g/s, asked {offset.onset_asked:.3g}"
    )
    if offset.roll_rate_rms is None or offset.pitch_rate_rms is None:
        return words
    return (
        f"{words}; of the rates beside it the roll rate is off by {offset.roll_rate_rms:.3g} and "
        f"the pitch rate by {offset.pitch_rate_rms:.3g} rad/s rms, the arm's own turning included"
    )
