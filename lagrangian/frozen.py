"""What does not change once it is made."""

from __future__ import annotations

from typing import Any

import numpy as np

__all__ = ["Frozen", "locked"]


class Frozen:
    """Its attributes can be set until ``__init__`` sets ``_made``; afterwards that raises AttributeError."""

    def __setattr__(self, name: str, value: Any) -> None:
        if "_made" in self.__dict__:
            raise AttributeError(f"{type(self).__name__} objects do not change, and the {name} of one is set to "
                                 f"{value}: make another one.")
        super().__setattr__(name, value)


def locked(array: Any) -> Any:
    """The same array, read only."""
    found = np.asarray(array).view()
    found.flags.writeable = False
    return found
