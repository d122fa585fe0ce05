# SPDX-License-Identifier: Apache-2.0
"""Frame ids below a namespace."""


def frame_in(namespace: str, frame: str) -> str:
    """`frame` below the `namespace` of a node, such as eel1/odom; without a leading slash, which tf2 refuses.

    So two robots in two namespaces do not share a frame.
    """
    return f"{namespace}/{frame}".strip("/")
