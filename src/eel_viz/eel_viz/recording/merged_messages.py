# SPDX-License-Identifier: Apache-2.0
"""Records messages from other sources than the network: of one swimmer, or of two for comparison."""

import heapq
from collections.abc import Callable, Iterable, Iterator, Sequence
from operator import itemgetter
from typing import Any

from eel_common.topics import SAMPLED

from eel_viz.message_readers import stamp_of
from eel_viz.recording.destination import Destination, LogFunction
from eel_viz.recording.dispatcher import Dispatcher
from eel_viz.recording.recordings import Recordings

Messages = Iterable[tuple[str, Any]]  # topic, a name of `READERS`, and message
MESSAGES_PER_POLL = 100


def record_messages(
    sources: Sequence[Messages],
    destinations: list[Destination],
    *,
    names: Sequence[str],
    namespaces: Sequence[str],
    log_warning: LogFunction,
    has_several_publishers: Callable[[str], bool] = lambda topic: False,
) -> str:
    """Record the messages of `sources`, one swimmer or two, to `destinations`.

    names: of the recording and of the compared swimmer. namespaces: of the swimmers, for their diagnostics.
    Returns the topics of the first source with their numbers of messages as text.
    """
    recordings = Recordings(
        destinations, name=names[0], log_warning=log_warning, has_several_publishers=has_several_publishers
    )
    dispatchers = [Dispatcher(recordings, namespace=namespaces[0], log_warning=log_warning)]
    if len(sources) > 1:
        dispatchers.append(
            Dispatcher(
                recordings,
                namespace=namespaces[1],
                log_warning=lambda text: log_warning(f"{names[1]}: {text}"),
                compared=f"/{names[1]}",
            )
        )
    try:  # a signal completes the recordings, an error discards them
        try:
            for k, (index, topic, message) in enumerate(merged_by_time(sources)):
                dispatchers[index].dispatch(topic, message)
                if k % MESSAGES_PER_POLL == 0:
                    recordings.poll()
        finally:
            received = [dispatcher.finish() for dispatcher in dispatchers]
    except Exception:
        recordings.discard()
        raise
    finally:
        recordings.close()
    return received[0]


def merged_by_time(sources: Sequence[Messages]) -> Iterator[tuple[int, str, Any]]:
    """All messages, merged by simulation time. Each source keeps its order. Yields source index, topic, message."""

    def timed(index: int, source: Messages) -> Iterator[tuple[int, int, str, Any]]:
        time = -1  # ns
        for topic, message in source:
            time = stamp_of(message) if topic in SAMPLED else time
            yield time, index, topic, message

    merged = heapq.merge(*(timed(index, source) for index, source in enumerate(sources)), key=itemgetter(0))
    return ((index, topic, message) for _, index, topic, message in merged)
