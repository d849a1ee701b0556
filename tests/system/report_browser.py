#!/usr/bin/python3
"""report.html in a headless Chromium, opened as a file: nothing is logged, all frames play, plots answer the pointer,
the themes change, and long runs stay small and responsive. Skipped (77) without chromium, chromium-driver and
python3-selenium.

usage: report_browser.py [TEST]...
       report_browser.py --measure FILE.json    times of slider steps with 25,000 grains and of a run of 1,000 frames
"""
import json
import os
import pathlib
import platform
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
import unittest

import report_page
from report_page import page
from furrow.plot.run_data import Run
from program import ROOT, SystemTest

FLAGS = ("--headless=new", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
         "--window-size=1200,1000", "--disable-dev-shm-usage", "--disable-background-networking",
         "--disable-component-update")
PLAY = """
const holder = document.querySelector('.playback'), slider = holder.querySelector('input[type=range]');
const stage = holder.querySelector('canvas').getContext('webgl2'), seconds = [], pictures = [];
for (let frame = 0; frame <= Number(slider.max); frame++) {
  const begin = performance.now();
  slider.value = frame;
  slider.dispatchEvent(new Event('input'));
  holder.player.draw();
  const { drawingBufferWidth: w, drawingBufferHeight: h } = stage, pixels = new Uint8Array(4 * w * h);
  stage.readPixels(0, 0, w, h, stage.RGBA, stage.UNSIGNED_BYTE, pixels);
  seconds.push((performance.now() - begin) / 1000);
  let sum = 0;
  for (let k = 0; k < pixels.length; k += 4) sum = (31 * sum + pixels[k] + 7 * pixels[k + 1]) % 1000003;
  pictures.push(sum);
}
return JSON.stringify({seconds, pictures, words: holder.querySelector('.time').textContent});
"""
# Plays the frames for some seconds; the longest time between two pictures, in which the page answers nobody.
STALL = """
const [seconds, done] = arguments, begin = performance.now();
let last = begin, longest = 0;
document.querySelector('.playback input[type=range]').value = 0;
document.querySelector('.playback input[type=range]').dispatchEvent(new Event('input'));
document.querySelector('.timeline button').click();
const look = (now) => {
  longest = Math.max(longest, now - last);
  last = now;
  if (now - begin < 1000 * seconds) requestAnimationFrame(look);
  else { document.querySelector('.timeline button').click(); done(longest / 1000); }
};
requestAnimationFrame(look);
"""
MOST_BYTES = 15e6  # of a page
MOST_STEP = 0.5  # s, of a slider step, drawn without a graphics card
MOST_STALL = 3.0  # s, while frames play and other programs use the cores


def browser():
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
    options = webdriver.ChromeOptions()
    options.binary_location = shutil.which("chromium")
    for flag in FLAGS:
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(options=options, service=Service(shutil.which("chromedriver")))


READY = "document.documentElement.dataset.ready === 'yes'"
PLAYBACK = "document.querySelector('.playback').dataset.ready === 'yes'"


def wait(driver, condition, patience=120):
    """Seconds until a condition holds."""
    begin = time.monotonic()
    while not driver.execute_script(f"return Boolean({condition})"):
        if time.monotonic() - begin > patience:
            raise AssertionError(f"not within {patience} s: {condition}")
        time.sleep(0.05)
    return time.monotonic() - begin


def complaints(driver):
    return [line["message"] for line in driver.get_log("browser") if line["level"] != "INFO"]


def opened(driver, page_file):
    """Seconds until the page is ready, and until its playback is."""
    begin = time.monotonic()
    driver.get(page_file.as_uri())
    wait(driver, READY)
    ready = time.monotonic() - begin
    driver.execute_script("document.querySelector('.playback').scrollIntoView()")
    wait(driver, PLAYBACK)
    return ready, time.monotonic() - begin


def provenance(command):
    """Where figures come from."""
    def printed(*words):
        return subprocess.run(words, text=True, capture_output=True).stdout.strip()
    return {"format_version": 1, "commit": printed("git", "-C", ROOT, "rev-parse", "--short", "HEAD"),
            "command": command, "browser": printed("chromium", "--version"), "cores": os.cpu_count()}


def measured(folder, frames, grains, shake=0.0):
    """Figures of the page of a run of so many frames and grains."""
    run = pathlib.Path(folder) / "run"
    report_page.known_run(run, count=frames, grains=grains, shake=shake)
    begin = time.monotonic()
    page.write(run, [Run(run)], lambda *_: True)
    made = time.monotonic() - begin
    driver = browser()
    try:
        driver.set_script_timeout(120)
        ready, playback = opened(driver, run / "report.html")
        played = json.loads(driver.execute_script(PLAY))
        stall = driver.execute_async_script(STALL, 3)
        renderer = driver.execute_script("const gl = document.createElement('canvas').getContext('webgl2'), about = "
                                         "gl.getExtension('WEBGL_debug_renderer_info'); return about ? "
                                         "gl.getParameter(about.UNMASKED_RENDERER_WEBGL) : ''")
        said = complaints(driver)
    finally:
        driver.quit()
    return {"frames": frames, "frames_shown": len(played["seconds"]), "grains": grains,
            "page_MB": round((run / "report.html").stat().st_size / 1e6, 2),
            "make_page_s": round(made, 2), "page_ready_s": round(ready, 2), "playback_ready_s": round(playback, 2),
            "slider_step_s": {"median": round(statistics.median(played["seconds"]), 3),
                              "largest": round(max(played["seconds"]), 3)},
            "longest_stall_while_playing_s": round(stall, 3), "renderer": renderer, "complaints": said}


class Long(SystemTest):
    def check(self, figures):
        self.assertEqual(figures["complaints"], [])
        self.assertLessEqual(figures["page_MB"], MOST_BYTES / 1e6, figures)
        self.assertLess(figures["slider_step_s"]["median"], MOST_STEP, figures)
        self.assertLess(figures["longest_stall_while_playing_s"], MOST_STALL, figures)

    def test_a_run_of_1000_frames_stays_small_and_responsive(self):
        figures = measured(self.folder, frames=1000, grains=12000, shake=report_page.RADIUS)  # frames of 18 MB
        self.check(figures)
        self.assertGreaterEqual(figures["frames_shown"], 60, figures)
        self.assertLess(figures["playback_ready_s"], 30, figures)

    def test_a_slider_step_with_25000_grains(self):
        figures = measured(self.folder, frames=12, grains=25000)
        self.check(figures)
        self.assertEqual(figures["frames_shown"], 12)


class InBrowser(SystemTest):
    def setUp(self):
        super().setUp()
        run = self.folder / "run"
        report_page.known_run(run, count=8)
        page.write(run, [Run(run)], lambda *_: True)
        self.page = run / "report.html"
        self.driver = browser()
        self.addCleanup(self.driver.quit)

    def ask(self, script):
        return self.driver.execute_script(script)

    def wait(self, script):
        wait(self.driver, script, 60)

    def test_the_page_works(self):
        self.driver.get(self.page.as_uri())
        self.wait(READY)
        self.frames_play()
        self.plots_answer()
        self.themes_change()
        self.rows_can_be_hidden()
        self.assertEqual(complaints(self.driver), [])

    def frames_play(self):
        self.ask("document.querySelector('.playback').scrollIntoView()")
        self.wait(PLAYBACK)
        played = json.loads(self.ask(PLAY))
        self.assertEqual(len(set(played["pictures"])), 8, played)  # every frame differs from the others
        self.assertIn("t = 0.350 s · frame 8 of 8", played["words"])
        self.assertLess(sorted(played["seconds"])[4], 0.5)
        button = "document.querySelector('.timeline button')"
        self.ask(f"{button}.click()")
        self.wait(f"document.querySelector('.playback').dataset.frame === '7' && {button}.textContent.includes('play')")
        for choice, value in ((0, "speed"), (0, "displacement"), (1, "pressure"), (1, "force")):
            self.ask(f"const list = document.querySelectorAll('.controls select')[{choice}]; list.value = '{value}'; "
                     "list.dispatchEvent(new Event('change'))")
        self.assertIn("contact", self.ask("const list = document.querySelectorAll('.controls select')[1]; list.value = "
                                          "'pressure'; list.dispatchEvent(new Event('change')); return "
                                          "document.querySelector('.scales').textContent"))

    def plots_answer(self):
        from selenium.webdriver.common.action_chains import ActionChains
        self.ask("document.querySelector('.chart').scrollIntoView()")
        self.wait("document.querySelector('.chart .u-over')")
        self.assertIn("N", self.ask("return document.querySelector('figcaption').textContent"))
        over = self.driver.find_element("css selector", ".chart .u-over")
        ActionChains(self.driver).move_to_element(over).perform()
        # 100 N/s in the middle of 0.25 s
        self.wait(r"/1\d\.\d+ N/.test(document.querySelector('.chart .u-legend').textContent)")
        ticks = "document.querySelector('.chart canvas').toDataURL()"
        before = self.ask(f"return {ticks}")
        ActionChains(self.driver).move_to_element(over).click_and_hold().move_by_offset(80, 0).release().perform()
        time.sleep(0.3)
        self.assertNotEqual(self.ask(f"return {ticks}"), before)  # zoomed

    def themes_change(self):
        colour = "return getComputedStyle(document.body).backgroundColor"
        before = self.ask(colour)
        self.ask("document.querySelector('.theme').click()")
        self.assertNotEqual(self.ask(colour), before)

    def rows_can_be_hidden(self):
        rows = ("return [...document.querySelectorAll('#scenario tbody tr')]"
                ".filter((row) => row.offsetHeight > 0).length")
        every = self.ask(rows)
        self.ask("document.querySelector('#scenario .box input').click()")
        self.assertLess(self.ask(rows), every)


def measure(file):
    """Writes the figures of both long pages, with where they come from."""
    figures = {**provenance("tests/system/report_browser.py --measure FILE.json"), "machine": platform.machine(),
               "pages": []}
    for frames, grains, shake in ((12, 25000, 0.0), (1000, 12000, report_page.RADIUS)):
        with tempfile.TemporaryDirectory(prefix="furrow page ") as folder:
            figures["pages"].append(measured(folder, frames, grains, shake))
    file.write_text(json.dumps(figures, indent=2) + "\n")


def main():
    try:
        import selenium  # noqa: F401
    except ImportError:
        sys.exit(77)
    if not (shutil.which("chromium") and shutil.which("chromedriver")):
        sys.exit(77)
    if sys.argv[1:2] == ["--measure"]:
        return measure(pathlib.Path(sys.argv[2]))
    unittest.main(verbosity=2)


if __name__ == "__main__":
    main()
