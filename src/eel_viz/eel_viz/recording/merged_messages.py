"""Messages of one swimmer, or of two that are compared, to their intakes, outside of a network."""

from collections.abc import Iterable, Iterator, Sequence

from eel_viz.messages import stamp_of
from eel_viz.recording.destination import Destination, Say
from eel_viz.recording.intake import SAMPLES, Intake
from eel_viz.recording.runs import OtherRuns, Runs

Messages = Iterable[tuple[str, object]]  # topic, a name of `Intake.topics`, and message
OFTEN = 100  # messages between two looks at what waits to be sent


def show(
    sources: Sequence[Messages],
    destinations: list[Destination],
    *,
    names: Sequence[str],
    namespaces: Sequence[str],
    warn: Say,
    crowded=lambda topic: False,
) -> str:
    """The messages of `sources`, one swimmer or two, to `destinations`; returns in words what came of the first.

    `names` are those of the recording and of the other; `namespaces` those whose diagnostics are taken.
    """
    runs = Runs(destinations, name=names[0], warn=warn, crowded=crowded)
    intakes = [Intake(runs, namespace=namespaces[0], warn=warn)]
    if len(sources) > 1:
        other = OtherRuns(runs, "/" + names[1])
        intakes.append(Intake(other, namespace=namespaces[1], warn=lambda text: warn(f"{names[1]}: {text}")))
    try:  # a signal ends the recordings here, an error drops them
        for k, (which, topic, message) in enumerate(abreast(sources)):
            intakes[which].take(topic, message)
            if k % OFTEN == 0:
                runs.attend()
    except Exception:
        for destination in destinations:
            destination.drop()
        raise
    finally:
        told = intakes[0].close()
    return told


def abreast(sources: Sequence[Messages]) -> Iterator[tuple[int, str, object]]:
    """All messages, those of each source in their order, the one that is behind in simulated time first.

    Yields the source's number, topic and message.
    """
    waiting = {which: iter(source) for which, source in enumerate(sources)}
    times = dict.fromkeys(waiting, -1)  # ns
    heads = {}
    while waiting:
        for which in list(waiting):
            if which in heads:
                continue
            head = next(waiting[which], None)
            if head is None:
                del waiting[which]
                continue
            heads[which] = head
            if head[0] in SAMPLES:
                times[which] = stamp_of(head[1])
        if heads:
            which = min(heads, key=lambda each: (times[each], each))
            yield which, *heads.pop(which)
