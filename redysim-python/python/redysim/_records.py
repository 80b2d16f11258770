"""Results of several parts."""

from __future__ import annotations

from typing import Any, SupportsIndex

import numpy as np


class Records(np.recarray):
    """A record array whose dtype has records from the start. For other record arrays NumPy makes sure of that in Python,
    which takes longer than a compiled function of one state."""

    # NumPy does not call this very function.
    __array_finalize__ = np.ndarray.__array_finalize__  # type: ignore[assignment]

    def __reduce_ex__(self, protocol: SupportsIndex) -> Any:
        """Pickles a record array of NumPy, which programs without redysim can read."""
        return self.view(np.recarray).__reduce_ex__(protocol)
