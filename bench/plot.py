"""Curves on two logarithmic axes, as an SVG file that needs no other."""
import html
import math

WIDTH, HEIGHT = 560, 320
LEFT, RIGHT, TOP, BOTTOM = 64, 130, 14, 44  # margins
COLORS = ["#2457c5", "#b45309", "#15803d", "#9333ea", "#b91c1c", "#0e7490", "#6b7280"]
STYLE = ("svg{background:#fff;font:11px system-ui,sans-serif}text{fill:#556}.grid{stroke:#e3e6ea}"
         ".middle{text-anchor:middle}.end{text-anchor:end}.line{fill:none;stroke-width:1.6}")


class Axis:
    """From the decade of the least value to that of the largest."""

    def __init__(self, values, begin, end):
        logs = [math.log10(value) for value in values]
        self.low, self.high = math.floor(min(logs)), max(math.ceil(max(logs)), math.floor(min(logs)) + 1)
        self.begin, self.end = begin, end

    def decades(self):
        step = math.ceil((self.high - self.low) / 10)
        return [10.0**exponent for exponent in range(self.low, self.high + 1, step)]

    def at(self, value):
        return self.begin + (self.end - self.begin) * (math.log10(value) - self.low) / (self.high - self.low)


def _text(x, y, kind, content, extra=""):
    return f"<text class='{kind}' x='{x:.1f}' y='{y:.1f}'{extra}>{html.escape(content)}</text>"


def _frame(x, y, x_label, y_label):
    parts = []
    for value in x.decades():
        parts.append(f"<path class='grid' d='M{x.at(value):.1f} {y.end}V{y.begin}'/>")
        parts.append(_text(x.at(value), y.begin + 16, "middle", f"{value:g}"))
    for value in y.decades():
        parts.append(f"<path class='grid' d='M{x.begin} {y.at(value):.1f}H{x.end}'/>")
        parts.append(_text(x.begin - 6, y.at(value) + 4, "end", f"{value:g}"))
    parts.append(_text((x.begin + x.end) / 2, HEIGHT - 8, "middle", x_label))
    middle = (y.begin + y.end) / 2
    parts.append(_text(14, middle, "middle", y_label, f" transform='rotate(-90 14 {middle:.1f})'"))
    return parts


def _spread(places, least=12):
    """Heights of labels, moved down where they would overlap."""
    result, last = {}, -math.inf
    for name, place in sorted(places.items(), key=lambda item: item[1]):
        last = max(place, last + least)
        result[name] = last
    return result


def log_log_svg(curves, x_label, y_label):
    """`curves`: points (x, y) by name. Points that are not positive cannot be shown."""
    colors = dict(zip(curves, COLORS))
    curves = {name: [point for point in points if min(point) > 0] for name, points in curves.items()}
    curves = {name: points for name, points in curves.items() if points}
    x = Axis([point[0] for points in curves.values() for point in points], LEFT, WIDTH - RIGHT)
    y = Axis([point[1] for points in curves.values() for point in points], HEIGHT - BOTTOM, TOP)
    parts = _frame(x, y, x_label, y_label)
    labels = _spread({name: y.at(points[-1][1]) + 4 for name, points in curves.items()})
    for name, points in curves.items():
        color = colors[name]
        places = [(x.at(point[0]), y.at(point[1])) for point in points]
        path = "L".join(f"{px:.1f} {py:.1f}" for px, py in places)
        parts.append(f"<path class='line' stroke='{color}' d='M{path}'/>")
        parts += [f"<circle cx='{px:.1f}' cy='{py:.1f}' r='2.5' fill='{color}'/>" for px, py in places]
        parts.append(_text(places[-1][0] + 7, labels[name], "", name, f" style='fill:{color}'"))
    return (f"<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {WIDTH} {HEIGHT}' width='{WIDTH}' height='{HEIGHT}'>"
            f"<style>{STYLE}</style>{''.join(parts)}</svg>\n")
