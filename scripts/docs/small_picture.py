#!/usr/bin/python3
"""A scene.png made small enough for a page: 820 pixels wide, 256 colours.

usage: small_picture.py SCENE.png OUT.png    (needs Debian's python3-pil)

The colours are shared out between greys (the tire, the words), sky and soil before they are chosen: one palette for the
whole picture would give nearly all of them to the grains, and draw parts of the tire in the colour of sand.
"""
import sys

import numpy as np
from PIL import Image

WIDTH = 820  # pixels
SHARES = {"grey": 72, "sky": 40, "soil": 144}  # colours
GREY = 14  # largest difference between red, green and blue of a grey
BRIGHT = 175  # of 255, mean of the three: brighter pixels that are not brown are sky


def part_of(pixels):
    """0, 1 or 2 for each pixel: grey, sky or soil."""
    red, blue, bright = pixels[:, 0], pixels[:, 2], pixels.mean(1)
    brown = red - blue > GREY
    return np.where(brown, 2, np.where(bright > BRIGHT, 1, 0))


def palette_of(pixels, colours):
    """As many colours as represent these pixels best, shape (colours, 3)."""
    line = Image.fromarray(pixels.astype(np.uint8)[None])
    made = line.quantize(colours, method=Image.Quantize.MEDIANCUT, kmeans=8)
    return np.array(made.getpalette()[:3 * colours]).reshape(-1, 3)


def small(picture):
    picture = picture.convert("RGB")
    picture = picture.resize((WIDTH, round(picture.height * WIDTH / picture.width)), Image.Resampling.LANCZOS)
    pixels = np.asarray(picture).reshape(-1, 3).astype(int)
    part = part_of(pixels)
    colours = np.vstack([palette_of(pixels[part == k], count) for k,
                         count in enumerate(SHARES.values()) if np.any(part == k)])
    palette = Image.new("P", (1, 1))
    palette.putpalette(colours.astype(np.uint8).ravel().tolist())
    return picture.quantize(palette=palette, dither=Image.Dither.NONE)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__.split("\n\n")[1])
    small(Image.open(sys.argv[1])).save(sys.argv[2], optimize=True)
