"""Which code runs a chain: the compiled kernel, or `plain` where Numba is missing or switched off."""

from __future__ import annotations

import warnings
from typing import Any


def _kernel() -> Any:
    try:
        import numba

        config: Any = numba.config  # type: ignore[attr-defined]
        if not config.DISABLE_JIT:
            from precursors.solver import kernel

            return kernel
        reason = "Numba is switched off (NUMBA_DISABLE_JIT)"
    except ImportError:
        reason = "Numba is not installed"
    warnings.warn(f"{reason}: chains are run by plain Python, a thousand times slower", stacklevel=2)
    return None


def __getattr__(name: str) -> Any:
    """Make KERNEL when it is first asked for: who only reads a run waits for no compiler."""
    if name != "KERNEL":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    globals()[name] = kernel = _kernel()
    return kernel
