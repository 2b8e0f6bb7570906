"""Sheets at random: the same seed, the same sheet.

The seed's remainder names the kind; numpy's PCG64 with that seed draws the rest. Every sheet is some 100 mm large, then turned and
moved at random. The thickness is drawn log-uniformly from 0.1 % to 20 % of the size.

| kind | what it may hold |
|---|---|
| fan | 3 to 7 plates on one line at random angles (at least 1 degree apart), of unequal lengths, cells of any size against t |
| strip | a strip with a bend; its radius may be less than half the thickness, it may nearly close or overlap itself |
| saddle | a saddle of random curvatures with a leaning fin on its middle line |
| box | a box with partitions one way and the other; the top and some walls may be missing |
| crossing | 2 to 4 plates through each other without any node in common |
| waves | a corrugated sheet whose waves are nearer than the thickness, or farther |
| twist | a strip turned about its axis by half turns and closed or not: one turn has one side only |
| touching | plates that have one node in common, and no edge |
"""

import math

import numpy as np

from sheet_files import Patchwork, placed


def _cells(random, most=14):
    return int(random.integers(1, most + 1))


def fan(random):
    work = Patchwork()
    count = int(random.integers(3, 8))
    while True:
        angles = np.sort(random.uniform(0, 2 * math.pi, count))
        gaps = np.diff(np.append(angles, angles[0] + 2 * math.pi))
        if gaps.min() > math.radians(1):
            break
    width, along = random.uniform(20, 100), _cells(random, 20)
    for angle in angles:
        leg = random.uniform(20, 80)
        direction = np.array([math.cos(angle), 0, math.sin(angle)])
        work.plate((0, 0, 0), leg * direction, (0, width, 0), (_cells(random, 20), along))
    return work


def strip(random):
    work = Patchwork()
    radius = 10 ** random.uniform(-0.7, 1.5)
    bend = math.radians(random.uniform(20, 330))
    width, ends = random.uniform(10, 60), random.uniform(5, 50, 2)
    arc = radius * bend

    def place(u, v):
        s = u * (ends[0] + arc + ends[1]) - ends[0]
        on = min(max(s, 0), arc) / radius
        x, z = radius * math.sin(on), radius * (1 - math.cos(on))
        rest = s - min(max(s, 0), arc)
        return x + rest * math.cos(on), width * v, z + rest * math.sin(on)

    return work.grid(place, int(random.integers(8, 60)), _cells(random, 8))


def saddle(random):
    work = Patchwork()
    a, b = random.uniform(-0.02, 0.02, 2)
    half, height, lean = random.uniform(20, 50), random.uniform(5, 40), random.uniform(-1.2, 1.2)
    n = _cells(random, 12)
    z = lambda x, y: a * x * x + b * y * y
    for side in (1, -1):
        def skin(u, v, side=side):
            x, y = half * (2 * u - 1), side * half * v
            return x, y, z(x, y)
        work.grid(skin, 2 * n, n)

    def fin(u, v):
        x = half * (2 * u - 1)
        return x, lean * height * v, z(x, 0) + height * v
    return work.grid(fin, 2 * n, _cells(random))


def box(random):
    work = Patchwork()
    size = random.uniform(20, 100, 3)
    places = []
    for k in range(2):
        inner = np.sort(random.uniform(0.1, 0.9, int(random.integers(0, 3)))) * size[k]
        places.append(np.concatenate([[0.0], inner, [size[k]]]))
    xs, ys = places
    cells = (_cells(random, 6), _cells(random, 6))
    for top in ([0.0, size[2]] if random.random() < 0.3 else [0.0]):
        for x0, x1 in zip(xs, xs[1:]):
            for y0, y1 in zip(ys, ys[1:]):
                work.plate((x0, y0, top), (x1 - x0, 0, 0), (0, y1 - y0, 0), cells[0])
    for x in xs:
        for y0, y1 in zip(ys, ys[1:]):
            if random.random() < 0.9:
                work.plate((x, y0, 0), (0, y1 - y0, 0), (0, 0, size[2]), cells)
    for y in ys:
        for x0, x1 in zip(xs, xs[1:]):
            if random.random() < 0.9:
                work.plate((x0, y, 0), (x1 - x0, 0, 0), (0, 0, size[2]), cells)
    return work


def crossing(random):
    work = Patchwork()
    for _ in range(int(random.integers(2, 5))):
        frame = turn(random)
        size = random.uniform(30, 100, 2)
        middle = random.uniform(-10, 10, 3)
        across, along = size[0] * frame[0], size[1] * frame[1]
        work.plate(middle - (across + along) / 2, across, along, (_cells(random, 8), _cells(random, 8)))
    return work


def waves(random):
    work = Patchwork()
    count, height = int(random.integers(1, 7)), random.uniform(1, 30)
    width = random.uniform(10, 60)
    n = int(random.integers(4, 14)) * count
    return work.grid(lambda u, v: (100 * u, width * v, height * math.sin(2 * math.pi * count * u)), n, _cells(random, 6))


def twist(random):
    work = Patchwork()
    halves, width, radius = int(random.integers(0, 4)), random.uniform(5, 25), random.uniform(25, 45)
    whole = 1.0 if random.random() < 0.6 else random.uniform(0.3, 0.95)

    def place(u, v):
        angle = 2 * math.pi * u * whole
        turned = math.pi * halves * u + 0.3
        out = radius + width * (v - 0.5) * math.cos(turned)
        return out * math.cos(angle), out * math.sin(angle), width * (v - 0.5) * math.sin(turned)

    return work.grid(place, int(random.integers(16, 60)), _cells(random, 6))


def touching(random):
    work = Patchwork()
    for _ in range(int(random.integers(2, 5))):
        frame = turn(random)
        size = random.uniform(15, 60, 2)
        work.plate((0, 0, 0), size[0] * frame[0], size[1] * frame[1], (_cells(random, 6), _cells(random, 6)))
    return work


def turn(random):
    """A rotation, all alike likely."""
    q, r = np.linalg.qr(random.normal(size=(3, 3)))
    q = q * np.sign(np.diag(r))
    return q if np.linalg.det(q) > 0 else -q


KINDS = [fan, strip, saddle, box, crossing, waves, twist, touching]


def of_seed(seed):
    """The sheet of a seed, and the words with which it is thickened."""
    random = np.random.default_rng(seed)
    kind = KINDS[seed % len(KINDS)]
    while True:
        work = kind(random)
        if work.faces:
            break
    sheet = work.sheet(f"{kind.__name__}-{seed}", 0.0)
    sheet.thickness = float(sheet.size * 10 ** random.uniform(-3, math.log10(0.2)))
    sheet = placed(sheet, turn(random), random.uniform(-100, 100, 3))
    words = ["--corners", "mitre" if random.random() < 0.5 else "round"]
    return sheet, words
