# SPDX-License-Identifier: Apache-2.0
"""The dual arm as arms, and one of its wires as it comes."""
import math

from svg import number, points, write

ROWS, SECONDS = 121, 4.0
COLORS = ("#2f5d9b", "#b3541e")
NAMES = ("left", "right")


def table():
    """Rows of a time and 18 positions: both arms reach out and swing, their bases move apart and back."""
    values = []
    for row in range(ROWS):
        part = row / (ROWS - 1)
        phase = 2 * math.pi * (part - math.sin(2 * math.pi * part) / (2 * math.pi))  # slow at both ends
        swing, reach = math.sin(phase), (1 - math.cos(phase)) / 2
        arm = [0.9 * swing, 0.7 * reach, -0.8 * reach, 0.5 * swing, 0.6 * swing, swing]
        values += [part * SECONDS, *arm, *(-a if i in (0, 3, 5) else a for i, a in enumerate(arm)),
                   -0.15 * reach, 0.1 * swing, 0.3 * swing, 0.15 * reach, 0.1 * swing, -0.3 * swing]
    return [round(value, 4) for value in values]


def run(robot):
    """Has the table followed; gives what the wire `state` sent on the way, from the first row on."""
    robot.set("table", table())
    robot.call("change_mode", 1)
    first = robot.get("state")["sample"] + 1000  # time for the next call
    robot.call("follow_table", ROWS, first)
    states = robot.watch("state", SECONDS + 1.5)
    return [((state["sample"] - first) / 1000, state) for state in states if 0 <= state["sample"] - first <= 1000 * SECONDS]


def project(place):
    """Metres to the picture, seen from the front, the side and above."""
    x, y, z = place
    return 430 + 165 * x + 40 * y, 290 - 165 * z - 70 * y + 8 * x


def links(position, arm):
    """Where an arm's links begin and end: foot, shoulder, elbow, wrist, tool."""
    joints = position[6 * arm:6 * arm + 6]
    x, y, turned = position[12 + 3 * arm:15 + 3 * arm]
    foot = (x + (1.0 if arm else -1.0), y, 0.0)
    shoulder = (foot[0], foot[1], 0.55)
    heading = turned + joints[0] - math.pi / 2
    pitch, places = 0.9, [foot, shoulder]
    for length, bend in ((0.55, -joints[1]), (0.45, -0.7 - joints[2]), (0.2, joints[4] - 0.4)):
        pitch += bend
        reach = length * math.cos(pitch)
        last = places[-1]
        places.append((last[0] + reach * math.cos(heading), last[1] + reach * math.sin(heading), last[2] + length * math.sin(pitch)))
    return places


def arm_lines(position, arm, opacity):
    places = [project(place) for place in links(position, arm)]
    yield f'<g stroke="{COLORS[arm]}" fill="none" stroke-linecap="round" stroke-linejoin="round" opacity="{opacity}">'
    for width, first, last in ((13, 0, 1), (10, 1, 2), (7.5, 2, 3), (4, 3, 4)):
        yield f'<polyline stroke-width="{number(width)}" points="{points(places[first:last + 1])}"/>'
    yield "</g>"
    if opacity == 1:
        for x, y in places[1:4]:
            yield f'<circle cx="{number(x)}" cy="{number(y)}" r="4" fill="#fff" stroke="#333"/>'


def grid():
    for i in range(-4, 5):
        yield f'<path d="M{points([project((i / 2, -1, 0))])} L{points([project((i / 2, 1, 0))])}" stroke="#dde1e7"/>'
    for i in range(-2, 3):
        yield f'<path d="M{points([project((-2, i / 2, 0))])} L{points([project((2, i / 2, 0))])}" stroke="#dde1e7"/>'
    corner = (-2, -1, 0)
    for name, tip in (("x", (-1.6, -1, 0)), ("y", (-2, -0.4, 0)), ("z", (-2, -1, 0.35))):
        x, y = project(tip)
        yield f'<path d="M{points([project(corner)])} L{points([(x, y)])}" stroke="#555" stroke-width="1.6"/>'
        yield f'<text x="{number(x + 5)}" y="{number(y - 3)}" fill="#333">{name}</text>'


def draw_arms(states, path):
    """Both arms at five times of the movement, the last ones strong, and the way of their tools."""
    lines = list(grid())
    shown = [states[int(part * (len(states) - 1))][1]["position"] for part in (0.02, 0.3, 0.38, 0.62, 0.7)]
    for arm in (0, 1):
        way = [project(links(state["position"], arm)[-1]) for _, state in states]
        lines.append(f'<polyline points="{points(way[::4])}" fill="none" stroke="{COLORS[arm]}" stroke-dasharray="2 4" stroke-width="1.4"/>')
        for index, position in enumerate(shown):
            lines += arm_lines(position, arm, 1 if index == len(shown) - 1 else round(0.10 + 0.08 * index, 2))
        x, y = project((1.0 if arm else -1.0, -0.35, 0))
        lines.append(f'<text x="{number(x)}" y="{number(y + 26)}" text-anchor="middle" fill="{COLORS[arm]}">{NAMES[arm]} arm, six axes</text>')
    lines.append('<text x="430" y="24" text-anchor="middle" font-weight="bold">The dual arm follows a table: 18 axes, 1,000 commands a second</text>')
    write(path, 860, 440, "The dual arm at five times of a movement", lines)


def draw_wire(states, path):
    """The first axis of each arm over time, drawn as its values come; it begins again by itself."""
    left, right, top, bottom = 70, 820, 50, 230
    limit = 1.0
    def place(time, value):
        return left + (right - left) * time / SECONDS, (top + bottom) / 2 - (bottom - top) / 2 * value / limit
    lines = ['<text x="70" y="28" font-weight="bold">wire <tspan font-family="monospace">state</tspan>: the first axis of each arm, in radians</text>']
    for value in (-1, -0.5, 0, 0.5, 1):
        y = place(0, value)[1]
        lines.append(f'<path d="M{left} {number(y)} H{right}" stroke="#e2e5ea"/><text x="60" y="{number(y + 4)}" text-anchor="end" fill="#555">{value:g}</text>')
    for second in range(int(SECONDS) + 1):
        x = place(second, 0)[0]
        lines.append(f'<path d="M{number(x)} {bottom} v5" stroke="#888"/><text x="{number(x)}" y="{bottom + 20}" text-anchor="middle" fill="#555">{second} s</text>')
    for arm in (0, 1):
        way = [place(time, state["position"][6 * arm]) for time, state in states][::3]
        turn = f'dur="{number(SECONDS + 1)}s" repeatCount="indefinite"'
        path_text = "M" + " L".join(f"{number(x)} {number(y)}" for x, y in way)
        lines.append(f'<path d="{path_text}" pathLength="1" fill="none" stroke="{COLORS[arm]}" stroke-width="2.4" stroke-dasharray="1 1">'
                     f'<animate attributeName="stroke-dashoffset" values="1;0;0" keyTimes="0;0.8;1" {turn}/></path>')
        lines.append(f'<circle r="5" fill="{COLORS[arm]}"><animateMotion path="{path_text}" keyPoints="0;1;1" keyTimes="0;0.8;1" calcMode="linear" {turn}/></circle>')
        lines.append(f'<text x="{right - 100 * (2 - arm) + 10}" y="28" fill="{COLORS[arm]}">{NAMES[arm]} arm</text>')
    write(path, 860, 270, "Two values of a wire as they come", lines)
