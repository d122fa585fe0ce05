# SPDX-License-Identifier: Apache-2.0
"""Shows a made-up swimmer in a file and to a viewer that does not read, and tells the memory; a process of its own.

Usage: stuck_viewer.py FILE SINK PORT MEGABYTES: SINK is connect (the viewer listens on PORT) or serve (on PORT; whoever
comes is the viewer). Goes on for 6 s at least, until the file has so much, and until the viewer has been found stuck,
but no further than three times as much: buffers hide it for a while. Prints lines of JSON: seconds, MB of the file, MB
of memory that this process has for itself, and what was said so far.
"""

import json
import sys
import time
from pathlib import Path

import made_up
from eel_common.files.output_file import part_of
from eel_common.ros.process_end import exit_immediately
from eel_viz.recording.recordings import Recordings
from eel_viz.recording.sinks import destinations
from eel_viz.settings import Settings
from made_up_recording import body, sample

STEP = 10**7  # ns
NOTICED = 6.0  # s, by when it has been said that the viewer does not read, where buffers are full at once
SIGNS = "has not read", "does not answer", "does not keep up"
MOST = 3.0  # of the megabytes
WAIT = 0.5  # s between two lines


def anonymous_memory() -> float:
    """[MB], without what is mapped from files."""
    return float(Path("/proc/self/status").read_text().split("RssAnon:")[1].split()[0]) / 1e3


def main() -> None:
    path, sink, port, wanted = Path(sys.argv[1]), sys.argv[2], int(sys.argv[3]), float(sys.argv[4])
    settings = Settings(
        sink=("save", sink), recording=str(path), skin_rate=1000.0, rate=1000.0, memory_limit="16MiB", index=False,
        port=port, viewer=f"rerun+http://127.0.0.1:{port}/proxy",
    )  # fmt: skip
    said: list[str] = []
    made = Recordings(destinations(settings, said.append, said.append, live=True), "eel", said.append)
    made.log_lasting("body", body())
    print("ready", flush=True)
    sys.stdin.readline()  # until the viewer is stuck
    samples = [sample(made_up.Swimmer(51), k * STEP) for k in range(100)]
    began, told, now, k = time.monotonic(), 0.0, 0.0, 0

    def tell() -> None:
        print(json.dumps([now, part_of(path).stat().st_size / 1e6, anonymous_memory(), said]), flush=True)

    def done() -> bool:
        size, stuck = part_of(path).stat().st_size / 1e6, any(sign in line for sign in SIGNS for line in said)
        return now >= NOTICED and size >= wanted and (stuck or size >= MOST * wanted)

    while not done():
        stamp = k * STEP
        for topic, arguments in samples[k % len(samples)].items():
            made.log_sample(topic, stamp, arguments)
        k += 1
        if k % 10 == 0:
            made.poll()
        now = time.monotonic() - began
        if now - told > WAIT:
            told = now
            tell()
    tell()
    print("done", flush=True)
    made.close()
    exit_immediately(0)


if __name__ == "__main__":
    main()
