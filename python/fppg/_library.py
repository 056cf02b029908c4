"""Loads the library, with OpenMP teams that wait without spinning, as in the program: where other programs run, spinning
takes 2 to 4 times the processor time. What the user chose stays."""

import os

_CHOICES = ("OMP_WAIT_POLICY", "GOMP_SPINCOUNT")
_is_chosen = any(name in os.environ for name in _CHOICES)
if not _is_chosen:
    os.environ["OMP_WAIT_POLICY"] = "passive"
from . import _fppg  # noqa: E402 (OpenMP reads its policy once, when it is loaded)

if not _is_chosen:
    del os.environ["OMP_WAIT_POLICY"]

__all__ = ["_fppg"]
