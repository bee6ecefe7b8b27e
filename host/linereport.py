"""What a report says of the line: traffic, interruptions, and the robot's clock."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from host.outages import Interruption
from host.recording import Recording

Fields = dict[str, Any]


def interruption(each: Interruption, recording: Recording) -> Fields:
    """Return when the line was interrupted, for how long, why, and what was missed."""
    return {
        "at_s": recording.seconds(each.host_ms),
        "for_s": each.for_ms / 1000,
        "cause": each.cause,
        "telemetry_missed": each.telemetry_missed,
    }


def line_lines(fields: Fields) -> Iterator[str]:
    """Yield what the line did, and how the robot's clock stood to the host's."""
    for each in fields["interruptions"]:
        when = f"at {each['at_s']:.2f} s for {each['for_s']:.2f} s"
        yield f"  interrupted      {when}: {each['cause']}; {each['telemetry_missed']} records missed"
    link = fields["link"]
    traffic = f"{link['bytes_sent']} bytes out, {link['bytes_received']} in, {link['frames_resent']} frames resent"
    missed = f"{link['telemetry_missed']} missed{_by_slot(link['telemetry_missed_by_slot'])}"
    yield f"  line             {traffic}, {link['frames_damaged']} damaged, {missed}"
    if link.get("clock_bound_ms") is not None:
        drift = f"drifts {link['clock_drift_ppm']:.0f} ppm, known to {link['clock_bound_ms']:.1f} ms"
        offset_s = link["clock_offset_ms"] / 1000
        yield f"  robot's clock    {abs(offset_s):.3f} s {'ahead of' if offset_s > 0 else 'behind'} the host's, {drift}"


def _by_slot(missed: dict[str, int]) -> str:
    """Return which subscription missed how many records, where there were others than the usual one."""
    if set(missed) <= {"0"}:
        return ""
    return f" ({', '.join(f'slot {slot}: {count}' for slot, count in missed.items())})"
