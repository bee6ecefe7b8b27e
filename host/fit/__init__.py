"""What a press tells of the material that it pressed: its moduli and viscosities, from the force over time.

scipy is an extra of softrig, imported by the modules in here only.
"""

from __future__ import annotations

from host.errors import BadRequest


def check_scipy() -> None:
    """Raise BadRequest where nothing can be fitted."""
    try:
        import scipy.optimize  # noqa: F401, PLC0415
    except ImportError as error:
        raise BadRequest("a fit needs scipy: pip install 'softrig[fit]'") from error
