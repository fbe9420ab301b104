# SPDX-License-Identifier: Apache-2.0
"""Held-out rows as `kelpie learn` has them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _kelpie

Rows = NDArray[np.intp]


class BlockSplit:
    """Rows that are held out in blocks of time, as by `kelpie learn --split`: for scikit-learn's cv=.

    Neighbours in time are nearly equal, so that shuffled folds judge a model by rows it has all but
    seen. Blocks hold out whole stretches; one split of training and held-out rows.

    Parameters
    ----------
    kind : "blocks"; "pieces", 25 blocks of equal length, for short logs; "auto", blocks where the
        log has enough rows, else pieces; "tail", the last fifth.
    block_rows : rows of a block of "blocks".
    every : the last of every so many blocks is held out.
    """

    def __init__(self, kind: str = "blocks", *, block_rows: int = 400, every: int = 5) -> None:
        self.kind = kind
        self.block_rows = block_rows
        self.every = every

    def split(self, X: Any, y: Any = None,
              groups: Optional[ArrayLike] = None) -> Iterator[tuple[Rows, Rows]]:
        """The training rows and the held-out rows of X, once.

        `groups`, whole numbers, are the vehicle's configurations: each is split by itself. Raises
        ValueError on too few rows or an unknown kind.
        """
        if not isinstance(self.kind, str):
            raise ValueError(f"kind: {self.kind!r} is no kind of split such as 'blocks' or "
                             "'pieces'; there is one split, not several folds")
        rows = len(X)
        configurations = np.zeros(rows, dtype=int) if groups is None else np.asarray(groups)
        if configurations.shape != (rows,) or configurations.dtype.kind not in "iu":
            raise ValueError("groups: a whole number per row is wanted")
        training, held_out = _kelpie.split_rows(configurations.tolist(), self.kind,
                                                self.block_rows, self.every)
        yield training.astype(np.intp), held_out.astype(np.intp)

    def get_n_splits(self, X: Any = None, y: Any = None, groups: Any = None) -> int:
        """1."""
        return 1

    def __repr__(self) -> str:
        return f"BlockSplit({self.kind!r}, block_rows={self.block_rows}, every={self.every})"
