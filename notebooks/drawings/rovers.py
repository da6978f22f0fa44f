"""Rovers side by side, drawn by `rdk.figures.rover_picture`."""
import re

import numpy as np
from IPython.display import SVG

from rdk.figures import rover_picture
from rdk.rover_picture import svg


class Drawing(SVG):
    """An SVG that stands as its own words where no picture can be shown."""

    def __repr__(self):
        return re.search('aria-label="([^"]*)"', self.data)[1]


def rovers(results, scenario, width=260):
    """Rovers side by side, on one scale: `results` is name -> (Design, Performance) on the `scenario`."""
    spans = [max(d.wheelbase_m + 2 * (d.wheel_radius_m + d.grouser_height_m) + 0.06, np.sqrt(d.solar_area_m2))
             for d, _ in results.values()]
    scale = 0.9 * (width - 70) / max(spans)
    body, words, height = "", [], 0.0
    for i, (name, (design, performance)) in enumerate(results.items()):
        picture = rover_picture(design, performance, scenario, width=width, scale=scale)
        height = max(height, float(re.search(r'height="([\d.]+)"', picture)[1]))
        words.append(f"{name}: " + re.search('aria-label="([^"]*)"', picture)[1])
        body += (f'<g transform="translate({i * (width + 16)} 0)"><text class="b" x="4" y="14">{name}</text>'
                 f'<g transform="translate(0 18)">{picture}</g></g>')
    return Drawing(svg(len(results) * (width + 16), height + 18, body, " ".join(words)))
