#!/usr/bin/python3
"""report.html in a headless Chromium, opened as a file: nothing is logged, all frames play, plots answer the pointer, the
themes change. Skipped (77) without chromium, chromium-driver and python3-selenium."""
import json
import shutil
import sys
import time
import unittest

import report_page
from report_page import page
from plot.run_data import Run
from program import SystemTest

FLAGS = ("--headless=new", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
         "--window-size=1200,1000", "--disable-dev-shm-usage", "--disable-background-networking", "--disable-component-update")
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


def browser():
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
    options = webdriver.ChromeOptions()
    options.binary_location = shutil.which("chromium")
    for flag in FLAGS:
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(options=options, service=Service(shutil.which("chromedriver")))


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

    def wait(self, script, seconds=60):
        end = time.monotonic() + seconds
        while not self.ask(f"return Boolean({script})"):
            self.assertLess(time.monotonic(), end, script)
            time.sleep(0.05)

    def test_the_page_works(self):
        self.driver.get(self.page.as_uri())
        self.wait("document.documentElement.dataset.ready === 'yes'")
        self.frames_play()
        self.plots_answer()
        self.themes_change()
        self.rows_can_be_hidden()
        self.assertEqual([line for line in self.driver.get_log("browser") if line["level"] != "INFO"], [])

    def frames_play(self):
        self.ask("document.querySelector('.playback').scrollIntoView()")
        self.wait("document.querySelector('.playback').dataset.ready === 'yes'")
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
        self.assertIn("contact", self.ask("const list = document.querySelectorAll('.controls select')[1]; list.value = 'pressure'; "
                                          "list.dispatchEvent(new Event('change')); return document.querySelector('.scales').textContent"))

    def plots_answer(self):
        from selenium.webdriver.common.action_chains import ActionChains
        self.ask("document.querySelector('.chart').scrollIntoView()")
        self.wait("document.querySelector('.chart .u-over')")
        self.assertIn("N", self.ask("return document.querySelector('figcaption').textContent"))
        over = self.driver.find_element("css selector", ".chart .u-over")
        ActionChains(self.driver).move_to_element(over).perform()
        self.wait(r"/1\d\.\d+ N/.test(document.querySelector('.chart .u-legend').textContent)")  # 100 N/s in the middle of 0.25 s
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
        rows = "return [...document.querySelectorAll('#scenario tbody tr')].filter((row) => row.offsetHeight > 0).length"
        every = self.ask(rows)
        self.ask("document.querySelector('#scenario .box input').click()")
        self.assertLess(self.ask(rows), every)


def main():
    try:
        import selenium  # noqa: F401
    except ImportError:
        sys.exit(77)
    if not (shutil.which("chromium") and shutil.which("chromedriver")):
        sys.exit(77)
    unittest.main(verbosity=2)


if __name__ == "__main__":
    main()
