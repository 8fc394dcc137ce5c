# SPDX-License-Identifier: Apache-2.0
"""The smart room as a room: its lamps, its sensors, and the floor as its four cameras see it."""
from svg import number, png, points, rgb, write

WIDTH, DEPTH, HEIGHT = 8, 6, 3  # metres
FACTOR = 4  # of the cameras' pixels one of so many each way is drawn
SCALE = 38  # pixels a metre


def project(origin, place):
    """Seen from the south and above: y goes up to the right."""
    x, y, z = place
    return origin[0] + SCALE * (x + 0.42 * y), origin[1] - SCALE * (0.36 * y + 0.95 * z)


def triples(values):
    return [values[i:i + 3] for i in range(0, len(values), 3)]


def floor(room):
    """The four pictures as one, smaller: width, height, bytes."""
    tiles = {}
    for camera in range(4):
        x, y, _ = room.call(f"robcamera[{camera}].GetProperty", "Position")
        seen = room.call(f"robcamera[{camera}].GetCurrentStreamFrameCameraBitmap")
        tiles[x > WIDTH / 2, y > DEPTH / 2] = seen
        width, height = seen["width"], seen["height"]
    rows = []
    for is_north in (True, False):
        for row in range(0, height, FACTOR):
            for is_east in (False, True):
                data = tiles[is_east, is_north]["data"]
                for column in range(0, width, FACTOR):
                    at = 3 * (row * width + column)
                    rows.append(bytes(data[at:at + 3]))
    return 2 * width // FACTOR, 2 * height // FACTOR, b"".join(rows)


def walls(origin):
    corner = {(x, y, z): project(origin, (x * WIDTH, y * DEPTH, z * HEIGHT)) for x in (0, 1) for y in (0, 1) for z in (0, 1)}
    back = [corner[0, 1, 0], corner[1, 1, 0], corner[1, 1, 1], corner[0, 1, 1]]
    left = [corner[0, 0, 0], corner[0, 1, 0], corner[0, 1, 1], corner[0, 0, 1]]
    yield f'<polygon points="{points(back)}" fill="#e4e7ec" stroke="#b8bec8"/>'
    yield f'<polygon points="{points(left)}" fill="#d6dae1" stroke="#b8bec8"/>'


def floor_image(origin, room):
    """The picture lies on the floor: an affine map from its pixels."""
    width, height, data = floor(room)
    north_west = project(origin, (0, DEPTH, 0))
    a = SCALE * WIDTH / width
    c, d = -SCALE * 0.42 * DEPTH / height, SCALE * 0.36 * DEPTH / height
    return (f'<image width="{width}" height="{height}" transform="matrix({a:.4f} 0 {c:.4f} {d:.4f} '
            f'{number(north_west[0])} {number(north_west[1])})" preserveAspectRatio="none" href="{png(width, height, data)}"/>')


def lamps(origin, room, prefix):
    colors = triples(room.call("robdevice[0].GetProperty", "GetRGB"))
    places = triples(room.call("robdevice[0].GetProperty", "Positions"))
    for index, (place, color) in enumerate(zip(places, colors, strict=True), start=1):
        x, y = project(origin, place)
        bright = rgb(color, 1 / max(0.4, *color))
        name = f"{prefix}{index}"
        yield (f'<radialGradient id="{name}"><stop offset="0" stop-color="{bright}" stop-opacity="{0.25 + 0.6 * max(color):.2f}"/>'
               f'<stop offset="1" stop-color="{bright}" stop-opacity="0"/></radialGradient>')
        yield f'<ellipse cx="{number(x)}" cy="{number(y)}" rx="46" ry="40" fill="url(#{name})"/>'
        yield f'<ellipse cx="{number(x)}" cy="{number(y)}" rx="12" ry="6" fill="{rgb(color, 1.2)}" stroke="#444"/>'
        yield f'<text x="{number(x)}" y="{number(y - 11)}" text-anchor="middle" fill="#333">lamp {index}</text>'


def sensors(origin, room):
    readings = triples(room.call("robdevice[1].GetProperty", "ReadRGB"))
    places = triples(room.call("robdevice[1].GetProperty", "Positions"))
    for index, (place, reading) in enumerate(zip(places, readings, strict=True)):
        x, y = project(origin, place)
        foot = project(origin, (place[0], place[1], 0))
        yield f'<path d="M{number(x)} {number(y)} V{number(foot[1])}" stroke="#555" stroke-width="2"/>'
        yield f'<rect x="{number(x - 9)}" y="{number(y - 9)}" width="18" height="14" rx="3" fill="{rgb(reading, 5)}" stroke="#333"/>'
        yield (f'<text x="{number(x + 13)}" y="{number(y + 3)}" font-size="11" stroke="#fff" stroke-width="3" '
               f'paint-order="stroke">sensor {index}</text>')
        values = ", ".join(f"{part:.2f}" for part in reading)
        yield (f'<text x="{number(origin[0] + 40 + 170 * (index % 2))}" y="{number(origin[1] + 26 + 18 * (index // 2))}" font-size="12" '
               f'fill="#333">sensor {index}: {values}</text>')


def panel(room, x, heading, prefix):
    origin = (x + 10, 250)
    yield f'<text x="{x + 10}" y="26" font-weight="bold">{heading}</text>'
    yield from walls(origin)
    yield floor_image(origin, room)
    yield from sensors(origin, room)
    yield from lamps(origin, room, prefix)


def draw(room, path):
    """Before and after two calls that set lamps. `room` is a running service."""
    before = list(panel(room, 0, "as it starts", "before"))
    room.call("robdevice[0].SetProperty", "SetRGBRange", [1, 3, 0.05, 0.1, 0.9])
    room.call("robdevice[0].SetProperty", "SetRGBRange", [4, 5, 1, 0.55, 0.1])
    after = list(panel(room, 430, "lamps 1 to 3 blue, 4 and 5 amber", "after"))
    note = ('<text x="430" y="326" text-anchor="middle" fill="#333">Six lamps, four sensors (red, green, blue), and the floor as four '
            "cameras see it. All values come from calls of the service.</text>")
    write(path, 860, 340, "The smart room before and after two calls", [*before, *after, note])
