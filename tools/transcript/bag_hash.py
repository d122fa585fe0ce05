# SPDX-License-Identifier: Apache-2.0
"""Prints for each bag the number of messages of a topic, and a hash of all their bytes: `bag_hash.py TOPIC BAG...`.

Without a topic (`-`): the number of messages of each.
"""

import hashlib
import sys
from pathlib import Path

from rosbags.rosbag2 import Reader


def main(topic: str, *bags: str) -> int:
    for bag in bags:
        with Reader(Path(bag)) as reader:
            if topic == "-":
                print("\n".join(f"{each.topic}: {each.msgcount}" for each in sorted(reader.connections, key=str)))
                continue
            wanted = [each for each in reader.connections if each.topic == topic]
            messages = [bytes(data) for _, _, data in reader.messages(connections=wanted)]
        print(f"{bag}: {len(messages)} messages, sha256 {hashlib.sha256(b''.join(messages)).hexdigest()[:16]}")
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
