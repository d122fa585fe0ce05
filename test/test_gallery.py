# SPDX-License-Identifier: Apache-2.0
"""The gallery of the site, in a headless browser: a click opens a recording; and its page, its files and pictures."""

import io
import re
import time
from pathlib import Path

import browser
import gallery
import numpy as np
import pytest
from contrast import contrast_in
from eel_viz.plots import series
from eel_viz.scene3d import colours
from PIL import Image

from eel_dynamics import simulate
from eel_gaits import straight
from eel_viz import entities

ROOT = Path(__file__).resolve().parents[1]
needs_browser = pytest.mark.skipif(browser.found() is None, reason="no Chromium: apt-get install chromium")
WINDOW = 480, 400  # pixels: software draws
PAGE = """<!doctype html><meta charset="utf-8">{policy}<link rel="stylesheet" href="_static/site.css">
<body data-theme="{theme}"><section id="gallery"><section id="swim"><img src="_static/swim.webp"></section>
<section id="none"><img src="_static/swim.webp"></section></section>
<script src="_static/swims.js" defer></script>"""
HEARD = """window.heard = []; for (const swim of document.querySelectorAll(".swim")) {{
swim.dataset.backend = "webgl"; swim.addEventListener("viewer", (event) => heard.push(event.detail)); }}
document.querySelectorAll(".swim button")[{which}].click()"""


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """A small site: the site's own script, style and policy, the viewer, and one short recording."""
    folder = tmp_path_factory.mktemp("site")
    (folder / "recordings").mkdir()
    gallery.add_viewer(ROOT / "out" / "docs" / "_static" / "viewer")
    (folder / "_static").mkdir()
    (folder / "_static" / "viewer").symlink_to(ROOT / "out" / "docs" / "_static" / "viewer")
    for name in ("swims.js", "site.css"):
        (folder / "_static" / name).write_text((ROOT / "docs" / "site" / name).read_text())
    Image.new("RGB", (16, 9)).save(folder / "_static" / "swim.webp")
    policy = re.search(r'POLICY = """(.*)"""', (ROOT / "docs" / "conf.py").read_text())
    for theme in ("light", "dark"):
        page = PAGE.format(policy=policy[1], theme=theme)
        (folder / f"{theme}.html").write_text(page)
        (folder / f"plots-{theme}.html").write_text(page.replace('id="swim"', 'id="plots"'))
    run = simulate(straight(), 3.0, accuracy="draft", estimate=False, sample_period=0.25, stations=11)
    for name, blueprint in (("swim", "swimmer"), ("plots", "overview")):
        run.to_rerun(folder / "recordings" / f"{name}.rrd", blueprint=blueprint, rate=0.0)
    with browser.served(folder) as address:
        yield address


@pytest.fixture(params=["light", pytest.param("dark", marks=pytest.mark.soak)])
def opened(request, site, tmp_path):
    """A page of that theme whose recording is open."""
    with browser.browser(tmp_path) as page:
        page.open(f"{site}/{request.param}.html", *WINDOW)
        page.wait("document.querySelectorAll('.swim button').length > 0")
        page.value(HEARD.format(which=0))
        page.wait("heard.some((event) => event.type === 'recording_open')", limit=180.0)
        yield page, request.param


def colours_in(page: browser.Page) -> list:
    """The colours of the canvas with their numbers of pixels, most frequent first."""
    image = Image.open(io.BytesIO(page.screenshot("canvas"))).convert("RGB")
    return sorted(image.getcolors(1 << 24), reverse=True)


@needs_browser
@pytest.mark.soak
def test_a_click_opens_the_recording_in_the_page_s_theme_its_time_runs_and_nothing_leaves_the_site(opened, site):
    page, theme = opened
    end = time.monotonic() + 180.0
    while len(colours_in(page)) < 2000:  # a page without swimmer has some hundred
        assert time.monotonic() < end, page.text()
        time.sleep(2.0)
    times = "heard.filter((event) => event.type === 'time_update').map((event) => event.time)"
    page.wait(f"new Set({times}).size > 3", limit=180.0)
    told = page.value(times)
    assert all(0.0 <= time <= 3.1e9 for time in told) and np.ptp(told) > 0
    opening = page.value("heard.find((event) => event.type === 'recording_open')")
    assert opening["application_id"] == "eel"
    panels = [np.mean(colour) for count, colour in colours_in(page)[:3]]
    assert (max(panels) > 200) == (theme == "light"), colours_in(page)[:3]
    refused = {
        event["params"]["requestId"]
        for event in page.events
        if event["method"] == "Network.loadingFailed" and event["params"].get("blockedReason") == "csp"
    }
    sent = [event["params"] for event in page.events if event["method"] == "Network.requestWillBeSent"]
    strangers = [
        each["request"]["url"]
        for each in sent
        if not each["request"]["url"].startswith((site, "data:", "blob:")) and each["requestId"] not in refused
    ]
    assert len(sent) > 5 and strangers == []
    page.value("document.querySelectorAll('.swim button')[1].click()")  # close
    assert page.value("document.querySelectorAll('canvas').length") == 0


@needs_browser
@pytest.mark.soak
@pytest.mark.parametrize("theme", ["light", "dark"])
def test_curves_and_grids_have_a_contrast_of_3_in_either_theme(theme, site, tmp_path):
    with browser.browser(tmp_path) as page:
        page.open(f"{site}/plots-{theme}.html", 1100, 900)
        page.wait("document.querySelectorAll('.swim button').length > 0")
        page.value(HEARD.format(which=0))
        page.wait("heard.some((event) => event.type === 'recording_open')", limit=180.0)
        end, seen = time.monotonic() + 180.0, {"nothing": 0.0}
        while min(seen.values()) < 3.0:
            assert time.monotonic() < end, seen
            time.sleep(5.0)
            image = np.asarray(Image.open(io.BytesIO(page.screenshot("canvas"))).convert("RGB")).astype(int)
            plots = image[:, image.shape[1] // 2 :]
            seen = {name: contrast_in(plots, colours.curve(colour)) for name, colour in series.SERIES[entities.POWER]}
            seen["grid"] = contrast_in(plots, colours.TICK)
        assert (image[5, -40:].mean() > 200) == (theme == "light")


@needs_browser
def test_a_recording_that_is_missing_is_told_in_words_and_the_picture_stays(site, tmp_path):
    with browser.browser(tmp_path) as page:
        page.open(f"{site}/dark.html", *WINDOW)
        page.wait("document.querySelectorAll('.swim button').length > 0")
        page.value("document.querySelectorAll('.swim')[1].querySelector('button').click()")
        page.wait("document.body.innerText.includes('No viewer: the recording is not on this site')")
        assert page.value("document.querySelectorAll('.swim img').length") == 2


def test_each_swim_has_a_small_picture_three_sentences_and_code_that_writes_its_recording():
    sections = gallery.sections()
    assert len(sections) == 8
    text = gallery.PAGE.read_text()
    for name, code in sections.items():
        assert f'"{name}.rrd"' in code
        assert f"(images/gallery/{name}.webp)" in text
        assert (gallery.PICTURES / f"{name}.webp").stat().st_size < gallery.LARGEST_PICTURE


def test_code_that_writes_no_recording_of_its_name_is_refused(tmp_path):
    with pytest.raises(ValueError, match=r"the code of wave in gallery.md must write wave.rrd"):
        gallery.record("wave", "print('swims')", tmp_path / "wave.rrd")
