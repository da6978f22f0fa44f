"""Rovers side by side, drawn by `rdk.figures.rover_picture`."""
import re

import numpy as np
from IPython.display import SVG

from rdk.figures import rover_picture
from rdk.rover_picture import element, svg, text

EACH_ROW = 3


class Drawing(SVG):
    """An SVG that stands as its own words where no picture can be shown."""

    def __repr__(self):
        return re.search('aria-label="([^"]*)"', self.data)[1]


def rovers(results, scenario, width=260):
    """Rovers on one scale, three a row: `results` is name -> (Design, Performance) on the `scenario`."""
    spans = [max(d.wheelbase_m + 2 * (d.wheel_radius_m + d.grouser_height_m) + 0.06, np.sqrt(d.solar_area_m2))
             for d, _ in results.values()]
    scale = 0.9 * (width - 70) / max(spans)
    body, words, top, lowest = "", [], 0.0, 0.0
    for i, (name, (design, performance)) in enumerate(results.items()):
        if i % EACH_ROW == 0:
            top = lowest
        picture = rover_picture(design, performance, scenario, width=width, scale=scale)
        height, said = re.search('height="([0-9.]+)" .*?aria-label="([^"]*)"', picture, re.S).groups()
        words.append(f"{name}: {said}")
        lowest = max(lowest, top + float(height) + 28)
        body += element("g", "", text(4, 14, name, "b") + element("g", "", picture, transform="translate(0 18)"),
                        transform=f"translate({i % EACH_ROW * (width + 16)} {top:g})")
    return Drawing(svg(min(len(results), EACH_ROW) * (width + 16), lowest, body, " ".join(words)))
