# SPDX-License-Identifier: Apache-2.0
"""The messages of one swimmer in a bag, for `Run.from_bag` of the library."""

import os
import warnings
from collections.abc import Iterator

from eel_viz.bags.bag import Bag
from eel_viz.bags.replay import Source


def run_messages(path: str | os.PathLike[str], namespace: str | None = None) -> Iterator[tuple[str, object]]:
    """Yield topic (without namespace) and message of the swimmer in the bag at `path`, in the recorded order.

    namespace: the swimmer's; None: that of the only one. A damaged bag is read as far as it goes, with a warning.
    `ValueError` in one line if it cannot be read.
    """

    def log_warning(text: str) -> None:
        warnings.warn(text, stacklevel=3)

    with Bag(path) as bag:
        if bag.damage:
            log_warning(f"{path} is unfinished or damaged ({bag.damage}): read as far as it goes")
        yield from Source(bag, namespace, log_warning, law_message=lambda message, place: message)
