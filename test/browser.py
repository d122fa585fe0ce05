# SPDX-License-Identifier: Apache-2.0
"""A headless Chromium that tests drive by its debugging pipe, and a server of files for it; nothing but the standard
library. Software draws, so the browser needs no graphics card.
"""

import base64
import contextlib
import fcntl
import functools
import json
import os
import shutil
import subprocess
import threading
import time
from collections.abc import Iterator
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

NAMES = "chromium", "chromium-browser", "google-chrome", "google-chrome-stable"
FLAGS = (
    "--headless=new --no-sandbox --remote-debugging-pipe --use-angle=swiftshader --enable-unsafe-swiftshader "
    "--ignore-gpu-blocklist --disable-dev-shm-usage --no-first-run --disable-background-networking"
)


def found() -> str | None:
    """The path of Chromium; None if it is not installed."""
    return next((path for name in NAMES if (path := shutil.which(name))), None)


class Page:
    """The one page of a browser. `events`: those of the browser so far, in the order in which they came."""

    def __init__(self, to_browser: int, from_browser: int) -> None:
        self._to, self._from = to_browser, from_browser
        self._left, self._number, self._session = b"", 0, ""
        self.events: list[dict[str, Any]] = []
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self._session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        self.call("Network.enable")

    def open(self, address: str, width: int, height: int) -> None:
        """Go to the `address`, in a window of these pixels."""
        size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
        self.call("Emulation.setDeviceMetricsOverride", **size)
        self.call("Page.navigate", url=address)

    def value(self, expression: str) -> Any:
        """The value of a JavaScript expression, awaited."""
        how = {"returnByValue": True, "awaitPromise": True}
        answer = self.call("Runtime.evaluate", expression=expression, **how)
        assert "exceptionDetails" not in answer, answer["exceptionDetails"]
        return answer["result"].get("value")

    def wait(self, expression: str, limit: float = 90.0) -> Any:
        """The value of the expression as soon as it is true. `AssertionError` after `limit` [s]."""
        end = time.monotonic() + limit
        while not (value := self.value(expression)):
            assert time.monotonic() < end, f"{expression} is still {value}; the page says: {self.text()}"
            time.sleep(0.5)
        return value

    def text(self) -> str:
        """The words on the page."""
        return str(self.value("document.body.innerText"))

    def screenshot(self, element: str) -> bytes:
        """The first element that the CSS selector finds, as PNG."""
        of_page = "({x, y, width, height}) => ({x: x + scrollX, y: y + scrollY, width, height})"
        box = self.value(f"({of_page})(document.querySelector('{element}').getBoundingClientRect())")
        return base64.b64decode(self.call("Page.captureScreenshot", clip={**box, "scale": 1})["data"])

    def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """The answer to a command of the browser."""
        self._number += 1
        message = {"id": self._number, "method": method, "params": parameters}
        if self._session:
            message["sessionId"] = self._session
        os.write(self._to, json.dumps(message).encode() + b"\0")
        while True:
            answer = self._message()
            if answer.get("id") == self._number:
                assert "error" not in answer, answer
                return dict(answer["result"])
            self.events.append(answer)

    def _message(self) -> dict[str, Any]:
        while b"\0" not in self._left:
            part = os.read(self._from, 1 << 20)
            assert part, "the browser has ended"
            self._left += part
        text, _, self._left = self._left.partition(b"\0")
        return dict(json.loads(text))


@contextlib.contextmanager
def browser(profile: Path) -> Iterator[Page]:
    """A browser that keeps its files in `profile`; it ends with the context."""
    program = found()
    assert program
    theirs_in, ours_out = os.pipe()
    ours_in, theirs_out = os.pipe()

    def pipes() -> None:  # Chromium reads from 3 and writes to 4
        high = [fcntl.fcntl(end, fcntl.F_DUPFD, 10) for end in (theirs_in, theirs_out)]
        for end, number in zip(high, (3, 4), strict=True):
            os.dup2(end, number)

    process = subprocess.Popen(
        [program, *FLAGS.split(), f"--user-data-dir={profile}"],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        preexec_fn=pipes,
        close_fds=False,
    )
    os.close(theirs_in)
    os.close(theirs_out)
    try:
        yield Page(ours_out, ours_in)
    finally:
        os.close(ours_out)
        process.terminate()
        process.wait(timeout=30)
        os.close(ours_in)


@contextlib.contextmanager
def served(folder: Path) -> Iterator[str]:
    """The address of a server of the files in `folder`, on this machine alone."""

    class Quiet(SimpleHTTPRequestHandler):
        def log_message(self, format: str, *args: Any) -> None:
            pass

    server = ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=str(folder)))
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    try:
        yield f"http://127.0.0.1:{server.server_port}"
    finally:
        server.shutdown()
        thread.join()
        server.server_close()
