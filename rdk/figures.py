"""Figures in one style that reads without colour: curves and panels for a notebook's cell, and live pictures."""
import base64
import html
import io
import threading

import matplotlib.pyplot as plt

from .rover_picture import rover_picture as rover_picture, wheel_picture as wheel_picture

BLUE, ORANGE, GREEN, BLACK, GREY = "#0072B2", "#D55E00", "#009E73", "#000000", "#767676"
COLOURS = (BLUE, ORANGE, GREEN, BLACK)
DASHES = ("-", "--", "-.", ":")
MARKERS = ("o", "s", "^", "D", "v", "P", "X")

STYLE = {"figure.figsize": (6.4, 3.8), "figure.dpi": 100, "font.size": 10, "axes.grid": True, "grid.alpha": 0.3,
         "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False, "lines.linewidth": 1.8}


def panels(rows=1, columns=1, *, figure=None, **options):
    """A `figure`, or a new one of pyplot, in one style, and its axes; `options` go to `matplotlib.pyplot.subplots`."""
    with plt.rc_context(STYLE):
        if figure is None:
            return plt.subplots(rows, columns, layout="constrained", **options)
        figure.set_layout_engine("constrained")
        return figure, figure.subplots(rows, columns, **{k: v for k, v in options.items() if k != "figsize"})


def curves(x, series, x_label="", y_label="", *, axes=None, legend=True):
    """One curve for each entry of `series` (label -> y), told apart by colour and dashes, on `axes` or a new figure.

    `x` is one array for all curves or a dictionary with an array for each. Returns the axes.
    """
    axes = panels()[1] if axes is None else axes
    for i, (label, y) in enumerate(series.items()):
        axes.plot(x[label] if isinstance(x, dict) else x, y, color=COLOURS[i % 4], linestyle=DASHES[i % 4],
                  linewidth=1.8, label=label)
    axes.set(xlabel=x_label, ylabel=y_label)
    if legend and len(series) > 1:
        axes.legend(frameon=False, fontsize=9)
    return axes


def live(draw, *, size=(5.2, 3.6), **sliders):
    """A picture, `size` inches of 100 pixels, with sliders: drawn anew when one moves; it runs without a browser too.

    `draw` takes an empty matplotlib Figure and one number a slider, by name; it draws, and returns a sentence that says
    what the picture shows. It may run in several threads, one at a time: no pyplot in it. A slider is name=(low, high,
    step, start, label with unit). Returns an ipywidgets.HBox: `sliders` has the sliders by name, `picture` is the image
    with the sentence as its alternative text. Where there are no widgets the picture stands alone.
    """
    import ipywidgets as widgets

    class LivePicture(widgets.HBox):
        def _repr_mimebundle_(self, **options):          # a viewer without widgets shows the picture instead
            bundle = super()._repr_mimebundle_(**options)
            return {**bundle, "text/plain": self.sentence, "image/png": self.png}

    picture, said = widgets.HTML(), widgets.HTML()
    rows, controls, lock = [], {}, threading.Lock()
    for name, (low, high, step, start, label) in sliders.items():
        limits = dict(min=low, max=high, step=step, value=start, description=label,
                      style={"description_width": "110px"}, layout=widgets.Layout(width="310px"))
        controls[name] = widgets.FloatSlider(readout=False, **limits)
        number = widgets.BoundedFloatText(**limits)      # for keyboards and screen readers
        widgets.link((controls[name], "value"), (number, "value"))
        rows += [controls[name], number]
    panel = widgets.VBox([*rows, said], layout=widgets.Layout(flex="0 0 330px"))
    box = LivePicture([panel, picture])
    box.sliders, box.picture = controls, picture

    def redraw(change=None):
        with lock:                                       # JupyterLab may call from several threads
            file = io.BytesIO()
            with plt.style.context(STYLE, after_reset=True):         # a person's matplotlibrc stays outside
                figure = plt.Figure(figsize=size)
                box.sentence = draw(figure, **{name: control.value for name, control in controls.items()})
                figure.savefig(file, format="png", dpi=100)
            box.png, text = base64.b64encode(file.getvalue()).decode(), html.escape(box.sentence)
            picture.value = (f'<img width="{100 * size[0]:.0f}" height="{100 * size[1]:.0f}" alt="{text}" '
                             f'src="data:image/png;base64,{box.png}">')
            said.value = f'<div role="status">{text}</div>'

    for control in controls.values():
        control.observe(redraw, "value")
    redraw()
    return box
