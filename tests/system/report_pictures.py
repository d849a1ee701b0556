#!/usr/bin/python3
"""Pictures of pages as a browser shows them, and how large the pages of results are and how fast they open.

usage: report_pictures.py OUT NAME=FOLDER|FILE.html...     (needs chromium, chromium-driver, python3-selenium,
python3-pil)

Of a folder of results with report.html it writes OUT/NAME.jpg (the top, light), OUT/NAME_dark.jpg, and of a run with
frames OUT/NAME_playback.jpg; of another page OUT/NAME.jpg and OUT/NAME_dark.jpg. Prints JSON: size, seconds until the
page and its playback are ready, and what the browser complained about.
"""
import io
import json
import pathlib
import sys
import time

from PIL import Image

from report_browser import PLAYBACK, READY, browser, complaints, provenance, wait

WIDTH, MOST_BYTES = 900, 100_000  # of a picture: pixels, bytes
LATE = """
const slider = document.querySelector('.playback input[type=range]');
slider.value = Math.round(0.85 * slider.max);
slider.dispatchEvent(new Event('input'));
"""


def keep(driver, file):
    """The window as a JPEG."""
    time.sleep(0.5)
    picture = Image.open(io.BytesIO(driver.get_screenshot_as_png())).convert("RGB")
    picture = picture.resize((WIDTH, round(picture.height * WIDTH / picture.width)), Image.Resampling.LANCZOS)
    for quality in range(88, 30, -6):
        picture.save(file, quality=quality, optimize=True)
        if file.stat().st_size <= MOST_BYTES:
            return


def show(driver, name, page, results, out):
    """Pictures of one page, of results or another, and its figures."""
    begin = time.monotonic()
    driver.get(page.as_uri())
    figures = {"MB": round(page.stat().st_size / 1e6, 2)}
    if results:
        wait(driver, READY)
    figures["ready_s"] = round(time.monotonic() - begin, 2)
    if results and driver.execute_script("return Boolean(document.querySelector('.playback'))"):
        driver.execute_script("document.querySelector('.playback').scrollIntoView(); window.scrollBy(0, -90)")
        figures["playback_s"] = round(wait(driver, PLAYBACK), 2)
        driver.execute_script(LATE)
        keep(driver, out / f"{name}_playback.jpg")
        driver.execute_script("window.scrollTo(0, 0)")
    keep(driver, out / f"{name}.jpg")
    if results:
        driver.execute_script("if (matchMedia('(prefers-color-scheme: dark)').matches === false) "
                              "document.querySelector('.theme').click()")
    else:
        driver.execute_script("document.body.dataset.theme = 'dark'")
    keep(driver, out / f"{name}_dark.jpg")
    figures["complaints"] = complaints(driver)
    return figures


def main():
    if len(sys.argv) < 3 or not all("=" in one for one in sys.argv[2:]):
        sys.exit(__doc__.split("\n\n")[1])
    out, found = pathlib.Path(sys.argv[1]), {}
    out.mkdir(parents=True, exist_ok=True)
    driver = browser()
    try:
        for one in sys.argv[2:]:
            name, _, place = one.partition("=")
            place = pathlib.Path(place).resolve()
            results = place.is_dir()
            found[name] = show(driver, name, place / "report.html" if results else place, results, out)
    finally:
        driver.quit()
    command = " ".join(["tests/system/report_pictures.py", *sys.argv[1:]])
    print(json.dumps({**provenance(command), "pages": found}, indent=2))



if __name__ == "__main__":
    main()
