# SPDX-License-Identifier: Apache-2.0
"""A live swim in a browser: the web viewer reads what `sink:=serve` serves. A small canvas, for software draws."""

import time
from pathlib import Path

import browser
import gallery
import made_up
import pytest
from eel_viz.recording import sinks
from eel_viz.recording.recordings import Recordings
from eel_viz.settings import Settings
from eel_viz.viewer import free_port
from made_up_recording import body, sample

VIEWER = Path(__file__).resolve().parents[1] / "out" / "docs" / "_static" / "viewer"
LIMIT = 150.0  # s
STEP = 5 * 10**8  # ns between two samples
PAGE = """<!doctype html><meta http-equiv="Content-Security-Policy" content="connect-src 'self' http://127.0.0.1:{port}">
<canvas style="width: 240px; height: 135px"></canvas><script src="viewer/re_viewer.js"></script><script>
window.heard = [];
(async () => {{
  const body = (await fetch("viewer/re_viewer_bg.wasm.gz")).body.pipeThrough(new DecompressionStream("gzip"));
  await wasm_bindgen({{ module_or_path: new Response(body, {{ headers: {{ "content-type": "application/wasm" }} }}) }});
  const on_viewer_event = (text) => heard.push(JSON.parse(text));
  const options = {{ hide_welcome_screen: true, persist: false, enable_history: false, render_backend: "webgl" }};
  const handle = new wasm_bindgen.WebHandle({{ ...options, on_viewer_event }});
  await handle.start(document.querySelector("canvas"));
  handle.add_receiver("rerun+http://127.0.0.1:{port}/proxy");
  window.ready = true;
}})();
</script>"""


@pytest.mark.skipif(browser.found() is None, reason="no Chromium: apt-get install chromium")
def test_a_browser_follows_a_live_swim_and_lists_it_alone(tmp_path):
    """The server has no recording of its own, which would come first, empty."""
    port, said = free_port(), []
    settings = Settings(sink=("serve",), port=port, web_port=free_port(), rate=10.0, blueprint="swimmer")
    made = Recordings(sinks.destinations(settings, said.append, said.append, live=True), "eel", said.append)
    gallery.add_viewer(VIEWER)
    (tmp_path / "viewer").symlink_to(VIEWER)
    (tmp_path / "live.html").write_text(PAGE.format(port=port))
    with browser.served(tmp_path) as address, browser.browser(tmp_path / "profile") as page:
        page.open(f"{address}/live.html", 300, 200)
        page.wait("window.ready", LIMIT)
        made.log_lasting("body", body())
        swimmer, begun, count, seen = made_up.Swimmer(11), time.monotonic(), 0, []
        while len(set(seen)) < 3 or max(seen) < 2e9:
            assert time.monotonic() - begun < LIMIT, (seen, said)
            while count * STEP < (time.monotonic() - begun) * 1e9:
                for topic, values in sample(swimmer, count * STEP).items():
                    made.log_sample(topic, count * STEP, values)
                count += 1
            made.poll()
            time.sleep(0.2)
            seen = page.value("heard.filter(({type}) => type === 'time_update').map(({time}) => time)")
        opened = page.value("heard.filter(({type}) => type === 'recording_open').map((event) => event.recording_id)")
    made.close()
    assert sorted(seen) == seen and max(seen) < count * STEP
    assert len(set(opened)) == 1, opened
