# SPDX-License-Identifier: GPL-3.0-or-later
"""The compiled core: what methods have learned."""

from collections.abc import Mapping
from typing import Any

from numpy.typing import NDArray

from ._core_types import Path

class Model:
    """What a method has learned: named tensors, and texts that say how it came about. Immutable.

    method is a name of a-z, 0-9 and _; version, from 1 on, is of what the method keeps in its
    models; path is the file that it was read from.
    """

    def __init__(
        self,
        method: str,
        tensors: Mapping[str, NDArray[Any]] = ...,
        *,
        metadata: Mapping[str, str] = ...,
        version: int = 1,
    ) -> None:
        """Copies the tensors: of any shape, finite, types as NumPy's numbers of up to 8 bytes.

        Raises ValueError.
        """
    method: str
    version: int
    metadata: dict[str, str]
    path: str
    @property
    def tensors(self) -> dict[str, NDArray[Any]]:
        """Read-only views by name. Raises ValueError for types that NumPy lacks (BF16, F8)."""
    @property
    def tensor_infos(self) -> list[tuple[str, str, tuple[int, ...], int]]:
        """Name, element type as safetensors calls it, shape and bytes of each tensor."""
    def tensor(self, name: str) -> NDArray[Any]:
        """A read-only view. Raises KeyError, and ValueError for types that NumPy lacks."""

def read_model(path: Path) -> Model:
    """The model in an .smmodel, checked as a whole. Raises FormatError."""

def write_model(path: Path, model: Model) -> None:
    """Writes an .smmodel atomically. Raises OSError."""

def store_model(database: Path, model: Model) -> None:
    """Puts a model into a motion database, in place of the same method's; all else stays.

    The file is replaced atomically. Raises FormatError and OSError.
    """

def remove_model(database: Path, method: str) -> None:
    """Takes a method's model out of a motion database. Raises FormatError and OSError."""
