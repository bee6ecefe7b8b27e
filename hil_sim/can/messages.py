"""Frames of the bench as python-can's messages, and back."""

from can import Message

from hil_sim.can.host import Heard, Trouble
from hil_sim.devices.canframe import Frame


def message_of(happened: Heard | Trouble, channel: str) -> Message:
    """Return what has happened on the bus as python-can tells it, stamped with virtual time."""
    if isinstance(happened, Trouble):
        return Message(
            timestamp=happened.time_us / 1e6,
            arbitration_id=happened.kind,
            is_extended_id=False,
            is_error_frame=True,
            channel=channel,
            data=happened.detail,
        )
    frame = happened.frame
    return Message(
        timestamp=happened.time_us / 1e6,
        arbitration_id=frame.id,
        is_extended_id=frame.extended,
        is_remote_frame=frame.remote,
        channel=channel,
        dlc=frame.length if frame.remote else len(frame.data),
        data=frame.data,
        is_fd=frame.fd,
        is_rx=not happened.own,
        bitrate_switch=frame.brs,
        error_state_indicator=frame.esi,
    )


def frame_of(message: Message) -> Frame:
    """Return the frame of a message; ValueError when there is none like it."""
    if message.is_error_frame:
        raise ValueError("an error frame cannot be sent: errors happen")
    return Frame(
        message.arbitration_id,
        bytes(message.data),
        message.is_extended_id,
        message.is_remote_frame,
        message.dlc if message.is_remote_frame else -1,
        message.is_fd,
        message.is_fd and message.bitrate_switch,
    )
